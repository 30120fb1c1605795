#include "ajar/core/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>

#include "ajar/core/error.h"

namespace ajar {
namespace {

const char* cure(int error) {
  switch (error) {
    case ENOENT:
    case ENOTDIR:
      return "name another folder";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder that you may write to";
    case EFBIG:
      return "free some space, raise the limit on the size of files (ulimit -f), or choose another disk";
    case ENOSPC:
    case EDQUOT:
      return "free some space, or choose another disk";
    case EISDIR:
      return "name a file, not a folder";
    case ENAMETOOLONG:
      return "choose a shorter name";
    default:
      return "check the disk, or choose another folder";
  }
}

[[noreturn]] void fail(const std::string& path, int error) {
  throw Error(fmt::format("{}: cannot be written ({}); {}", path, std::strerror(error), cure(error)));
}

/// Writes, flushes where asked to, and closes; zero, or the error number.
int fill(int descriptor, bool flushed, const std::function<void(Sink&)>& write) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(::fdopen(descriptor, "wb"), std::fclose);
  if (!file) {
    const int error = errno;
    ::close(descriptor);
    return error;
  }
  Sink sink{file.get()};
  write(sink);
  if (sink.error == 0 && std::fflush(sink.file) != 0) sink.error = errno;
  if (sink.error == 0 && flushed && ::fsync(descriptor) != 0) sink.error = errno;
  if (std::fclose(file.release()) != 0 && sink.error == 0) sink.error = errno;
  return sink.error;
}

void write_direct(const std::string& path, const std::function<void(Sink&)>& write) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0) fail(path, errno);
  if (const int error = fill(file, false, write)) fail(path, error);
}

/// Where a file will be.
struct Place {
  std::string target;
  bool direct = false;         ///< it is there, and no regular file
  std::optional<mode_t> mode;  ///< permissions of what is there
};

// The end of a chain of symbolic links whose file is not there yet.
std::string end_of_links(const std::string& path) {
  constexpr int most = 40;  // as Linux has it
  std::filesystem::path end = path;
  std::error_code ignored;
  for (int links = 0; std::filesystem::is_symlink(end, ignored); ++links) {
    if (links == most) fail(path, ELOOP);
    end = end.parent_path() / std::filesystem::read_symlink(end, ignored);
  }
  return end.string();
}

Place place_of(const std::string& path) {
  if (path.empty()) throw Error("the name of the file to write is empty; name a file");
  struct stat old {};
  const bool exists = ::stat(path.c_str(), &old) == 0;
  if (exists && S_ISDIR(old.st_mode)) fail(path, EISDIR);
  std::error_code ignored;
  std::string target = exists ? std::filesystem::canonical(path, ignored).string() : end_of_links(path);
  if (target.empty()) target = path;
  Place place{target, exists && !S_ISREG(old.st_mode), {}};
  if (exists) place.mode = old.st_mode & 0777;
  return place;
}

/// Opens a temporary file that was not there, beside the target; aside becomes its name. mode: its permissions, but for
/// what the process's mask takes.
int open_aside(const std::string& path, const std::string& target, std::string& aside, mode_t mode = 0666) {
  for (int tries = 0;; ++tries) {
    aside = target + temporary_suffix();
    const int file = ::open(aside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file >= 0) return file;
    if (errno != EEXIST || tries == 100) fail(path, errno);
  }
}

/// Tries a file of the target's name in the nearest folder above it that is there: those between are made later.
void try_out(const std::string& path, const std::string& target) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path file = fs::absolute(target, error);
  fs::path folder = file.parent_path();
  while (!fs::exists(folder, error) && !error && folder.has_relative_path()) folder = folder.parent_path();
  if (error) fail(path, error.value());
  if (!fs::is_directory(folder, error)) fail(path, ENOTDIR);
  std::string aside;
  ::close(open_aside(path, (folder / file.filename()).string(), aside));
  ::unlink(aside.c_str());
}

}  // namespace

std::string temporary_suffix() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return fmt::format(".tmp{}-{:x}", ::getpid(), std::chrono::nanoseconds(now).count());
}

void Sink::bytes(const void* data, size_t size) {
  if (error == 0 && std::fwrite(data, 1, size, file) != size) error = errno != 0 ? errno : EIO;
}

std::string target_of(const std::string& path) { return place_of(path).target; }

void make_folder_of(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(target_of(path)).parent_path();
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error) fail(path, error.value());
}

void write_aside(const std::string& path, const std::function<void(Sink&)>& write) {
  make_folder_of(path);
  const Place place = place_of(path);
  if (place.direct) return write_direct(path, write);
  std::string aside;
  const int file = open_aside(path, place.target, aside, place.mode.value_or(0666));
  if (place.mode) ::fchmod(file, *place.mode);  // not every disk knows permissions
  int error = 0;
  try {
    error = fill(file, true, write);
  } catch (...) {
    ::unlink(aside.c_str());
    throw;
  }
  if (error == 0 && ::rename(aside.c_str(), place.target.c_str()) != 0) error = errno;
  if (error == 0) return;
  ::unlink(aside.c_str());
  fail(path, error);
}

void write_aside(const std::string& path, const void* bytes, size_t size) {
  write_aside(path, [&](Sink& sink) { sink.bytes(bytes, size); });
}

void write_text(const std::string& path, const std::string& text) { write_aside(path, text.data(), text.size()); }

bool is_there(const std::string& path) {
  std::error_code unknown;
  return std::filesystem::exists(path, unknown);
}

void require_readable(const std::string& path) {
  if (::faccessat(AT_FDCWD, path.c_str(), R_OK, AT_EACCESS) == 0 || errno != EACCES) return;
  throw Error(fmt::format("{}: may not be read; check its permissions, or name another file", path));
}

bool is_file(const std::string& path) {
  std::error_code unknown;
  return std::filesystem::is_regular_file(path, unknown);
}

std::vector<std::filesystem::path> files_in(const std::string& folder) {
  std::vector<std::filesystem::path> out;
  std::error_code error;  // a loop over entries would throw where one of them cannot be read
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    out.push_back(it->path());
  std::sort(out.begin(), out.end());
  return out;
}

void make_folder(const std::string& path) {
  std::error_code failure;
  std::filesystem::create_directories(path, failure);
  if (failure) throw Error(fmt::format("{}: this folder cannot be made ({}); name another", path, failure.message()));
}

void check_file(const std::string& path) {
  const Place place = place_of(path);
  if (place.direct) {
    if (::access(path.c_str(), W_OK) != 0) fail(path, errno);
    return;
  }
  if (place.mode && ::access(place.target.c_str(), W_OK) != 0) fail(path, errno);
  try_out(path, place.target);
}

void check_folder(const std::string& path) { try_out(path, (std::filesystem::path(path) / "ajar").string()); }

}  // namespace ajar
