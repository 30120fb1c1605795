#include "node.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "ajar/core/error.h"

namespace ajar {

namespace {
namespace fs = std::filesystem;
constexpr size_t max_text = size_t(1) << 30;  // far beyond any real scene

// What is in a folder, by names in small letters; of several that differ in capitals the first. Read once: thousands of
// names of a scene may differ.
const std::map<std::string, std::string>& listing_of(const Document& document, const fs::path& folder) {
  const auto [known, added] = document.listings.emplace(folder.string(), std::map<std::string, std::string>());
  if (!added) return known->second;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    known->second.emplace(lower(name), name);
  }
  return known->second;
}

// The file whose name differs in capitals alone, as it is spelt from the folder on; empty if there is none.
fs::path other_case(const Document& document, const fs::path& folder, const fs::path& name) {
  fs::path spelt;
  for (const fs::path& part : name) {
    std::error_code error;
    if (!fs::exists(folder / spelt / part, error)) {
      const auto& listing = listing_of(document, folder / spelt);
      const auto found = listing.find(lower(part.string()));
      if (found == listing.end()) return {};
      spelt /= found->second;
    } else {
      spelt /= part;
    }
  }
  std::error_code ignored;
  return fs::is_regular_file(folder / spelt, ignored) ? spelt : fs::path();
}

bool may_be_name(const std::string& name) {
  return !name.empty() && name.find('\0') == name.npos && name.size() <= 4096;
}

std::string with_slashes(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

std::vector<fs::path> where_to_look(const Document& document, const Node& node) {
  std::vector<fs::path> out(document.folders.begin(), document.folders.end());
  out.push_back(fs::path(document.files[node.file]).parent_path());
  out.push_back(".");
  return out;
}

struct Found {
  fs::path folder, name;  // empty: there is none
};

Found in_other_capitals(const Document& document, const Node& node, const std::string& name) {
  if (!may_be_name(name)) return {};
  for (const fs::path& folder : where_to_look(document, node))
    if (const fs::path other = other_case(document, folder, with_slashes(name)); !other.empty()) return {folder, other};
  return {};
}
}  // namespace

std::string pointer_problem(std::string_view head) {
  if (!head.starts_with("version https://git-lfs")) return {};
  return ": is a pointer of Git LFS, not the file itself; fetch it with \"git lfs pull\"";
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return text;
}

std::string snake_case(const std::string& name) {
  std::string out;
  const auto upper = [](char c) { return c >= 'A' && c <= 'Z'; };
  for (size_t i = 0; i < name.size(); ++i) {
    if (upper(name[i]) && i > 0 && !upper(name[i - 1]) && name[i - 1] != '_' && name[i - 1] != '-') out += '_';
    out += upper(name[i]) ? char(name[i] - 'A' + 'a') : name[i];
  }
  return out;
}

std::string read_text(const std::string& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found)
    throw Error(fmt::format("{}: there is no such file; check the name", path));
  if (status.type() == fs::file_type::none) throw Error(fmt::format("{}: cannot be read: {}", path, error.message()));
  if (fs::is_directory(status)) throw Error(fmt::format("{}: is a folder; name a file", path));
  if (!fs::is_regular_file(path, error)) throw Error(fmt::format("{}: is not a file", path));
  if (fs::file_size(path, error) > max_text) throw Error(fmt::format("{}: is larger than 1 GB", path));
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (const std::string problem = pointer_problem(text); !problem.empty()) throw Error(path + problem);
  return text;
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
}

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

std::string shortened(const std::string& text) {
  constexpr size_t most = 80;
  return text.size() > most ? fmt::format("{}...", std::string_view(text).substr(0, most)) : text;
}

const std::string* attribute(const Node& node, const char* name) {
  for (const auto& [key, value] : node.attributes)
    if (key == name) return &value;
  return nullptr;
}

std::string place(const Document& document, const Node& node) {
  std::string element = fmt::format("<{}", shortened(node.tag));
  if (!node.written.empty()) element += fmt::format(" type=\"{}\"", shortened(node.written));
  if (!node.named.empty()) element += fmt::format(" name=\"{}\"", shortened(node.named));
  if (!node.id.empty()) element += fmt::format(" id=\"{}\"", shortened(node.id));
  return fmt::format("{}:{}: {}>", document.files[node.file], node.line, element);
}

std::string missing_file(const Document& document, const Node& node, const std::string& name) {
  const std::string said =
      fmt::format("there is no file \"{}\" in {}", name.substr(0, 200), fmt::join(document.folders, " or "));
  if (const Found other = in_other_capitals(document, node, name); !other.name.empty())
    return fmt::format("{}, but \"{}\"; correct its capitals", said, other.name.string());
  return said + "; correct the name, or add its folder with <path value=\"...\"/>";
}

std::string find_file(const Document& document, const Node& node, const std::string& name) {
  if (!may_be_name(name)) return {};
  std::error_code ignored;
  const std::vector<fs::path> folders = where_to_look(document, node);
  for (const std::string& spelt : {name, with_slashes(name)})
    for (const fs::path& folder : folders)
      if (const fs::path path = folder / spelt; fs::is_regular_file(path, ignored)) return path.string();
  const Found other = document.old ? in_other_capitals(document, node, name) : Found();
  if (!other.name.empty()) return (other.folder / other.name).string();
  for (const std::string& folder : document.folders) {  // what may be there, so that reading it tells why not
    std::error_code error;
    const fs::path path = fs::path(folder) / name;
    if (!fs::exists(path, error) && error == std::errc::permission_denied) return path.string();
  }
  return {};
}

}  // namespace ajar
