// Enters: bytes, and the name of a file or folder.
// Leaves: the file, complete or not at all; or, before the work, why it could not be written.
#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ajar {

/// Where bytes go; remembers the first error of the disk and takes nothing after it.
struct Sink {
  std::FILE* file;
  int error = 0;  ///< errno of it; 0: none

  void bytes(const void* data, size_t size);
};

/// What the name of a temporary file ends in: the process and the time to the nanosecond, since numbers of processes
/// are not unique on a disk that several machines or containers share.
std::string temporary_suffix();

/// Where a file of this name is, or will be: at the end of symbolic links, whether there is something or not.
std::string target_of(const std::string& path);
/// Makes the folder that it lies in, and those above. Throws Error.
void make_folder_of(const std::string& path);

/// Calls write for a temporary file in the same folder, flushes it to the disk and renames it. A folder that is not
/// there is made. A file that is replaced leaves its permissions. A symbolic link stays, and what it leads to is
/// written; a name that exists and is no regular file (/dev/null, a pipe) is written to as it is. Throws Error that
/// names file, cause and cure; then no temporary file is left, and a file of that name is as it was.
void write_aside(const std::string& path, const std::function<void(Sink&)>& write);
void write_aside(const std::string& path, const void* bytes, size_t size);
void write_text(const std::string& path, const std::string& text);
/// Whether a file or folder of this name is there, as far as can be told.
bool is_there(const std::string& path);
/// The same of a regular file.
bool is_file(const std::string& path);
/// Throws Error where a file is there that may not be read.
void require_readable(const std::string& path);
/// Names of all that lies in a folder, in order, with the folder's before them; of what cannot be read as much as can.
std::vector<std::filesystem::path> files_in(const std::string& folder);
/// Makes a folder and those above it; one that is there already will do. Throws Error.
void make_folder(const std::string& path);

/// Throws Error where write_aside would: tries it, with a file that it takes away again; makes no folder.
void check_file(const std::string& path);
/// Throws Error where files could not be written into the folder, once make_folder has made it; makes nothing.
void check_folder(const std::string& path);

}  // namespace ajar
