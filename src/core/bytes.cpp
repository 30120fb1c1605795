#include "ajar/core/bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>

#include "ajar/core/error.h"

namespace ajar {
namespace {

constexpr size_t magic_size = sizeof FileKind::magic - 1;

}  // namespace

uint64_t checksum(const void* data, size_t n, uint64_t sum) {
  const char* at = static_cast<const char*>(data);
  uint64_t word = 0;
  // Every step can be undone, given the word: two runs that differ in one word never meet again.
  const auto add = [&](uint64_t w) { sum = std::rotl(sum ^ w, 29) * 0x9e3779b97f4a7c15ull + 1; };
  for (; n >= sizeof word; n -= sizeof word, at += sizeof word) {
    std::memcpy(&word, at, sizeof word);
    add(word);
  }
  word = 0;
  if (n > 0) {
    std::memcpy(&word, at, n);
    add(word);
  }
  return sum;
}

std::string difference(std::string_view there, std::string_view here) {
  if (there.ends_with('}') && here.ends_with('}')) there.remove_suffix(1), here.remove_suffix(1);
  const auto take = [&](size_t front, size_t back) {
    for (std::string_view* key : {&there, &here}) key->remove_prefix(front), key->remove_suffix(back);
  };
  const size_t front =
      size_t(std::mismatch(there.begin(), there.end(), here.begin(), here.end()).first - there.begin());
  take(front > 0 ? there.rfind(',', front - 1) + 1 : 0, 0);
  const auto last = std::mismatch(there.rbegin(), there.rend(), here.rbegin(), here.rend()).first;
  const size_t comma = there.find(',', size_t(last.base() - there.begin()));
  take(0, comma == there.npos ? 0 : there.size() - comma);
  std::string text = fmt::format("there {}, here {}", there, here);
  for (char& c : text)  // of a damaged file; terminals obey some
    if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7f) c = '?';
  return text;
}

void Writer::bytes(const void* data, size_t n) {
  if (n == 0) return;
  out.bytes(data, n);
  sum = checksum(data, n, sum);
}

Reader::Reader(const std::string& file, const FileKind& file_kind) : path(file), kind(file_kind) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    if (std::filesystem::is_directory(path, error))
      throw Error(fmt::format("{}: is a folder; name a {}", path, kind.name));
    if (!error && std::filesystem::exists(path, error))
      throw Error(fmt::format("{}: is no regular file; copy this {} to one", path, kind.name));
    if (!error || error == std::errc::no_such_file_or_directory)
      throw Error(fmt::format("{}: no such {}; {}", path, kind.name, kind.make));
    throw Error(fmt::format("{}: this {} cannot be read ({})", path, kind.name, error.message()));
  }
  in.open(path, std::ios::binary);
  if (!in) throw Error(fmt::format("{}: this {} cannot be read; are you allowed to?", path, kind.name));
  left = std::filesystem::file_size(path, error);
  char found[magic_size] = {};
  if (left >= magic_size) bytes(found, magic_size);
  if (std::memcmp(found, kind.magic, magic_size) != 0)
    throw Error(fmt::format("{}: not a {} of this version of ajar; {}", path, kind.name, kind.cure));
}

void Reader::require(bool holds) const {
  if (!holds) throw Error(fmt::format("{}: {} is damaged; {}", path, kind.name, kind.cure));
}

void Reader::bytes(void* data, size_t n) {
  if (n == 0) return;
  require(n <= left && in.read(static_cast<char*>(data), std::streamsize(n)));
  left -= n;
  sum = checksum(data, n, sum);
}

size_t Reader::count(size_t bytes_each) {
  uint64_t n = 0;
  value(n);
  require(n <= left / bytes_each);
  return size_t(n);
}

void Reader::text(std::string& s) {
  s.resize(count(1));
  bytes(s.data(), s.size());
}

void Reader::check_seal() {
  const uint64_t expected = sum;
  uint64_t stored = 0;
  value(stored);
  require(stored == expected);
}

void Reader::finish() {
  check_seal();
  require(left == 0);
}

void write_file(const std::string& path, const FileKind& kind, const std::function<void(Writer&)>& write) {
  write_aside(path, [&](Sink& sink) {
    Writer w{sink};
    w.bytes(kind.magic, magic_size);
    write(w);
    w.seal();
  });
}

}  // namespace ajar
