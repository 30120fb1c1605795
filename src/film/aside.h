// Enters: the bytes of a file.
// Leaves: the file, complete or not at all.
#pragma once

#include <cstddef>
#include <string>

namespace ajar {

/// Writes the bytes to a temporary file in the same folder, flushes it to the disk and renames it. A name that exists
/// and is no regular file (/dev/null, a pipe) is written to as it is. Throws Error; then no temporary file is left, and
/// a file of that name is as it was.
void write_aside(const std::string& path, const void* bytes, size_t size);

}  // namespace ajar
