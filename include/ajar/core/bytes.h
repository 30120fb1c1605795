// Enters: plain values and arrays.
// Leaves: a file of their bytes with a checksum, written aside and renamed (files.h); and the values back from it,
// every count checked against the bytes that are left.
#pragma once

#include <cstdint>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "ajar/core/files.h"

namespace ajar {

/// Of some bytes after others whose sum is given: any single changed word changes it.
uint64_t checksum(const void* data, size_t n, uint64_t sum);

/// What two keys, parts divided by commas, do not have in common, for messages: "there A, here B".
std::string difference(std::string_view there, std::string_view here);

/// Bytes in the order of the calls; the same machine, or one of the same byte order, reads them.
struct Writer {
  Sink& out;
  uint64_t sum = 0;

  void bytes(const void* data, size_t n);
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(&v, sizeof v);
  }
  template <class T>
  void array(const std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    value(uint64_t(v.size()));
    bytes(v.data(), v.size() * sizeof(T));
  }
  void text(const std::string& s) { array(std::vector<char>(s.begin(), s.end())); }
  /// A checksum of all so far.
  void seal() { value(uint64_t(sum)); }
  /// What a file's contents are of, sealed: a reader can tell what is damaged from what is another's.
  void key(const std::string& s) { text(s), seal(); }
};

/// What a file is to be, for its first bytes and for messages.
struct FileKind {
  char magic[9];     ///< eight letters that name kind and version
  const char* name;  ///< "checkpoint"
  const char* make;  ///< what the user can do where there is no such file
  const char* cure;  ///< what the user can do about a damaged one
};

struct Reader {
  Reader(const std::string& path, const FileKind& kind);  ///< throws Error where the file is none of this kind

  std::string path;
  const FileKind& kind;
  std::ifstream in;
  uint64_t left = 0;  ///< bytes of the file that are still to be read: a damaged count must not allocate more
  uint64_t sum = 0;

  void bytes(void* data, size_t n);
  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(&v, sizeof v);
  }
  template <class T>
  void array(std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    v.resize(count(sizeof(T)));
    bytes(v.data(), v.size() * sizeof(T));
  }
  void text(std::string& s);
  /// A count of things that take so many bytes each at least; throws Error where the file cannot hold them.
  size_t count(size_t bytes_each);
  /// Throws Error unless what was read is as it was sealed.
  void check_seal();
  void key(std::string& s) { text(s), check_seal(); }
  /// Throws Error unless the file ends here, with a seal.
  void finish();
  /// Throws Error where a value cannot be.
  void require(bool holds) const;
};

/// Calls write; the file is written as write_aside does. Throws Error.
void write_file(const std::string& path, const FileKind& kind, const std::function<void(Writer&)>& write);

}  // namespace ajar
