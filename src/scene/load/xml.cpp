#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <pugixml.hpp>
#include <set>
#include <string_view>

#include "ajar/core/error.h"
#include "entities.h"
#include "node.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

// Far beyond any real scene; they stop files that mean to exhaust stack or memory.
constexpr int max_depth = 64;
constexpr int max_include_depth = 15;
constexpr size_t max_nodes = 8'000'000;
constexpr size_t max_value = 1 << 20;

using Parameters = std::map<std::string, std::string, std::less<>>;

struct Reader {
  Document& document;
  pugi::xml_node root;           // of the scene's own file
  Parameters parameters;         // from the command line, then what <default> adds
  Parameters later;              // defaults that stand below their use, looked up when one is missing
  std::set<std::string> looked;  // files searched for them
  std::set<std::string> declared, used;
  std::vector<std::string> including;  // canonical paths from the scene to the file being read
  size_t nodes = 0;
};

struct Source {
  const std::string& text;
  std::vector<size_t> newlines;
  uint32_t file = 0;
  std::string folder;
};

Source make_source(const std::string& text, uint32_t file, const std::string& folder) {
  Source s{text, {}, file, folder};
  for (size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i + 1)) s.newlines.push_back(i);
  return s;
}

uint32_t line_at(const Source& s, ptrdiff_t offset) {
  const auto at = std::lower_bound(s.newlines.begin(), s.newlines.end(), size_t(std::max<ptrdiff_t>(offset, 0)));
  return uint32_t(at - s.newlines.begin()) + 1;
}

[[noreturn]] void fail(const Reader& r, const Source& s, const pugi::xml_node& node, const std::string& text) {
  throw Error(fmt::format("{}:{}: <{}>: {}", r.document.files[s.file], line_at(s, node.offset_debug()),
                          shortened(node.name()), text));
}

// What is wrong with a file as a whole is told with the element that names it.
template <class F>
auto told_at(const Reader& r, const Source& s, const pugi::xml_node& node, const F& f) {
  try {
    return f();
  } catch (const Error& error) {
    fail(r, s, node, error.what());
  }
}

std::string known_parameters(const Reader& r) {
  std::string list;
  for (const auto& [name, value] : r.parameters) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "no parameter is known" : "known are " + list;
}

// A file has one outermost element; Mitsuba too reads the first alone.
void tell_second(Document& document, const pugi::xml_node& first, const Source& s) {
  for (pugi::xml_node next = first.next_sibling(); next; next = next.next_sibling()) {
    if (next.type() != pugi::node_element) continue;
    document.notes.push_back(one_line(fmt::format(
        "{}:{}: <{}>: stands after the end of <{}>, which is all that is read of a file: left out",
        document.files[s.file], line_at(s, next.offset_debug()), shortened(next.name()), shortened(first.name()))));
    return;
  }
}

void parse(Document& document, pugi::xml_document& xml, const Source& s, const std::string& name) {
  const pugi::xml_parse_result result = xml.load_buffer(s.text.data(), s.text.size());
  if (result.status == pugi::status_no_document_element || s.text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw Error(fmt::format("{}: holds no XML element; a scene begins with <scene version=\"3.0.0\">", name));
  if (!result)
    throw Error(fmt::format("{}:{}: not well-formed XML: {}; repair what stands there", document.files[s.file],
                            line_at(s, result.offset), result.description()));
  tell_second(document, xml.document_element(), s);
}

// UTF-16, which some editors write, as UTF-8.
std::string to_utf8(const std::string& bytes) {
  const bool little = bytes.starts_with("\xff\xfe"), big = bytes.starts_with("\xfe\xff");
  if (!little && !big) return bytes;
  std::wstring wide;
  for (size_t i = 2; i + 1 < bytes.size(); i += 2) {
    const auto byte = [&](size_t k) { return uint32_t(static_cast<unsigned char>(bytes[i + k])); };
    const uint32_t unit = byte(big ? 1 : 0) | byte(big ? 0 : 1) << 8;
    const bool second = unit >> 10 == 0xdc00 >> 10 && !wide.empty() && uint32_t(wide.back()) >> 10 == 0xd800 >> 10;
    if (second)
      wide.back() = wchar_t(0x10000 + ((uint32_t(wide.back()) & 0x3ff) << 10 | (unit & 0x3ff)));
    else
      wide.push_back(wchar_t(unit));
  }
  return pugi::as_utf8(wide);
}

std::string expand(const std::string& text, const std::string& folder, const std::string& name) {
  return expand_entities(to_utf8(text), folder, name);
}

void look_ahead(Reader& r, const pugi::xml_node& xml, int depth);
void look_ahead(Reader& r, const std::string& path, int depth) {
  pugi::xml_document included;
  try {
    const std::string text = expand(read_text(path), fs::path(path).parent_path().string(), path);
    if (included.load_buffer(text.data(), text.size())) look_ahead(r, included.document_element(), depth);
  } catch (const Error&) {
  }
}

// Defaults that a file and those it includes give anywhere. Quiet about what is wrong: the real reading will tell.
void look_ahead(Reader& r, const pugi::xml_node& xml, int depth) {
  if (depth > max_depth) return;
  for (const pugi::xml_node& child : xml.children()) {
    const std::string_view tag = child.name();
    const std::string name = child.attribute("name").value(), value = child.attribute("value").value();
    if (tag == "default" && !name.empty() && value.find('$') == value.npos) r.later.emplace(name, value);
    if (tag != "include") look_ahead(r, child, depth + 1);
    if (tag != "include" || depth > max_include_depth) continue;
    Node here;
    const std::string path = find_file(r.document, here, child.attribute("filename").value());
    if (!path.empty() && r.looked.insert(path).second) look_ahead(r, path, depth + 1);
  }
}

// The parameter whose name the text begins with; of several, the longest is meant. In order of names it is the last up
// to the text, or else no longer than what that one has in common with it.
const Parameters::value_type* parameter_at(const Parameters& parameters, std::string_view text) {
  for (;;) {
    const auto above = parameters.upper_bound(text);
    if (above == parameters.begin()) return nullptr;
    const Parameters::value_type& last = *std::prev(above);
    if (text.starts_with(last.first)) return &last;
    text = {text.begin(), std::mismatch(text.begin(), text.end(), last.first.begin(), last.first.end()).first};
  }
}

// Puts in the value of every $name. After \ a dollar is one, but for version 0.x, where that is a folder of Windows.
// There a name without a value stays where a [ stands beside it.
std::string substitute(Reader& r, const Source& s, const pugi::xml_node& node, const char* value) {
  std::string out;
  std::string_view rest = value;
  for (size_t dollar; (dollar = rest.find('$')) != rest.npos;) {
    const bool literal = !r.document.old && dollar > 0 && rest[dollar - 1] == '\\';
    out += rest.substr(0, dollar - (literal ? 1 : 0));
    rest.remove_prefix(dollar + 1);
    if (literal) {
      out += '$';
      continue;
    }
    const auto* found = parameter_at(r.parameters, rest);
    if (found == nullptr) {
      if (r.looked.insert("").second) look_ahead(r, r.root, 0);
      found = parameter_at(r.later, rest);
    }
    if (found == nullptr && r.document.old && std::string_view(value).find('[') != std::string_view::npos) {
      out += '$';
      continue;
    }
    if (found == nullptr) {
      size_t n = 0;
      while (n < rest.size() && (std::isalnum(static_cast<unsigned char>(rest[n])) != 0 || rest[n] == '_')) ++n;
      const std::string name(rest.substr(0, n));
      if (name.empty()) fail(r, s, node, "a $ begins the name of a parameter, and none follows; leave it out");
      fail(
          r, s, node,
          fmt::format("the parameter ${} has no value: give -D {}=VALUE or write <default name=\"{}\" value=\"...\"/>; "
                      "{}",
                      name, name, name, known_parameters(r)));
    }
    r.used.insert(found->first);
    out += found->second;
    rest.remove_prefix(found->first.size());
    if (out.size() > max_value) fail(r, s, node, "its parameters expand to more than a million characters");
  }
  return out.append(rest);
}

// In XML an attribute stands once in an element; pugixml lets it pass.
void check_once(const Reader& r, const Source& s, const pugi::xml_node& xml) {
  std::vector<std::string_view> names;
  for (const pugi::xml_attribute& a : xml.attributes()) names.emplace_back(a.name());
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end())
    fail(r, s, xml,
         fmt::format("has the attribute {} more than once; leave one of them out", shortened(std::string(*twice))));
}

Node make_node(Reader& r, const Source& s, const pugi::xml_node& xml) {
  if (++r.nodes > max_nodes) fail(r, s, xml, "the scene has more than eight million elements");
  check_once(r, s, xml);
  Node node;
  node.file = s.file;
  node.line = line_at(s, xml.offset_debug());
  node.tag = snake_case(xml.name());
  if (node.tag == "look_at") node.tag = "lookat";
  for (const pugi::xml_attribute& a : xml.attributes()) {
    std::string value = substitute(r, s, xml, a.value());
    const std::string name = snake_case(a.name());
    if (name == "type") {
      node.type = lower(value);
      node.written = std::move(value);
    } else if (name == "name") {
      node.name = snake_case(value);
      node.named = std::move(value);
    } else if (name == "id") {
      node.id = std::move(value);
    } else {
      node.attributes.emplace_back(name, std::move(value));
    }
  }
  return node;
}

void read_children(Reader& r, const Source& s, const pugi::xml_node& xml, Node& into, int depth);

const std::string& need(const Reader& r, const Source& s, const pugi::xml_node& xml, const Node& node,
                        const char* name) {
  const std::string* value = attribute(node, name);
  if (value == nullptr || value->empty()) fail(r, s, xml, fmt::format("needs {}=\"...\"", name));
  return *value;
}

void read_default(Reader& r, const Source& s, const pugi::xml_node& xml, const Node& node) {
  const std::string name = xml.attribute("name").value();  // parameters keep their spelling
  if (name.empty()) fail(r, s, xml, "needs name=\"...\"");
  const std::string* value = attribute(node, "value");
  if (value == nullptr) fail(r, s, xml, "needs value=\"...\"");
  r.declared.insert(name);
  r.parameters.emplace(name, *value);
}

void read_include(Reader& r, const Source& s, const pugi::xml_node& xml, const Node& node, Node& into, int depth) {
  const std::string& name = need(r, s, xml, node, "filename");
  const std::string path = find_file(r.document, node, name);
  if (path.empty()) fail(r, s, xml, missing_file(r.document, node, name));
  std::error_code ignored;
  const std::string canonical = fs::weakly_canonical(path, ignored).string();
  if (std::find(r.including.begin(), r.including.end(), canonical) != r.including.end())
    fail(r, s, xml, fmt::format("{} includes itself; leave this out", name));
  if (int(r.including.size()) > max_include_depth)
    fail(r, s, xml, fmt::format("files include each other more than {} deep", max_include_depth));
  const std::string folder = fs::path(path).parent_path().string();
  const std::string text = told_at(r, s, xml, [&] { return expand(read_text(path), folder, path); });
  count_text(r.document, text);
  r.document.files.push_back(path);
  const Source inner = make_source(text, uint32_t(r.document.files.size() - 1), folder);
  pugi::xml_document parsed;
  told_at(r, s, xml, [&] { parse(r.document, parsed, inner, path); });
  r.including.push_back(canonical);
  const pugi::xml_node root = parsed.document_element();
  if (std::string_view(root.name()) == "scene") {
    read_children(r, inner, root, into, depth);
  } else {
    Node child = make_node(r, inner, root);
    read_children(r, inner, root, child, depth + 1);
    if (!node.named.empty()) child.name = node.name, child.named = node.named;
    into.children.push_back(std::move(child));
  }
  r.including.pop_back();
}

void read_path(Reader& r, const Source& s, const pugi::xml_node& xml, const Node& node) {
  const std::string* value = attribute(node, "value");
  if (value == nullptr) fail(r, s, xml, "needs value=\"...\"");
  const fs::path folder = value->empty() ? "." : *value;
  std::error_code ignored;
  for (const fs::path& candidate : {fs::path(s.folder) / folder, fs::path(r.document.folders.back()) / folder, folder})
    if (fs::is_directory(candidate, ignored)) {
      r.document.folders.insert(r.document.folders.begin(), candidate.string());
      return;
    }
  r.document.notes.push_back(
      fmt::format("{}: there is no folder {}: left out", place(r.document, node), folder.string()));
}

void read_alias(Reader& r, const Source& s, const pugi::xml_node& xml, const Node& node) {
  const std::string& as = need(r, s, xml, node, "as");
  const auto [known, added] = r.document.aliases.emplace(as, node);
  if (!added)
    fail(r, s, xml,
         fmt::format("the name \"{}\" is taken already by an <alias> at {}:{}; rename one of them", shortened(as),
                     r.document.files[known->second.file], known->second.line));
}

void read_children(Reader& r, const Source& s, const pugi::xml_node& xml, Node& into, int depth) {
  if (depth > max_depth)
    fail(r, s, xml, fmt::format("elements are nested more than {} deep; is an end tag missing?", max_depth));
  for (const pugi::xml_node& child : xml.children()) {
    if (child.type() != pugi::node_element) continue;
    Node node = make_node(r, s, child);
    if (node.tag == "default") {
      read_default(r, s, child, node);
    } else if (node.tag == "include") {
      read_include(r, s, child, node, into, depth);
    } else if (node.tag == "path") {
      read_path(r, s, child, node);
    } else if (node.tag == "alias") {
      read_alias(r, s, child, node);
    } else {
      read_children(r, s, child, node, depth + 1);
      into.children.push_back(std::move(node));
    }
  }
}

// 3.6.4 is before 3.7, and before 3.10.
bool before_3_7(std::string_view version) {
  if (!version.starts_with("3.")) return version.starts_with("2.") || version == "3";
  const std::string_view minor = version.substr(2, version.find('.', 2) - 2);
  return minor.size() == 1 && minor < "7";
}

void read_version(Document& document) {
  const std::string* version = attribute(document.root, "version");
  document.old = version != nullptr && version->starts_with("0.");
  document.by_name = version != nullptr && before_3_7(*version);
  if (version != nullptr && version->find_first_of("0123456789") == 0) return;
  const std::string wrong =
      version ? fmt::format("\"{}\" is not a version", shortened(*version)) : "needs version=\"...\"";
  document.notes.push_back(
      one_line(fmt::format("{}: {}: read as a scene of version 3", place(document, document.root), wrong)));
}

// Mitsuba 0.6 has toWorld alone. Versions 2 and 3 have to_world, and read files of 0.x by new names, not by old rules.
void heed_spelling(Reader& r, const Source& s) {
  const pugi::xml_node moved = r.root.find_node([](const pugi::xml_node& node) {
    const std::string_view tag = node.name(), name = node.attribute("name").value();
    return name == "to_world" && (tag == "transform" || tag == "animation");
  });
  if (!r.document.old || !moved) return;
  r.document.old = false, r.document.by_name = true;
  r.document.notes.push_back(one_line(
      fmt::format("{}:{}: version {} does not know to_world: read as a scene of version 2", r.document.files[s.file],
                  line_at(s, moved.offset_debug()), shortened(*attribute(r.document.root, "version")))));
}

}  // namespace

Document read_document(const std::string& text, const std::string& folder, const std::string& name,
                       const std::map<std::string, std::string>& defines) {
  Document document;
  document.files.push_back(name);
  document.folders.push_back(folder.empty() ? "." : folder);
  const std::string expanded = expand(text, document.folders.front(), name);
  count_text(document, expanded);
  const Source source = make_source(expanded, 0, document.folders.front());
  pugi::xml_document xml;
  parse(document, xml, source, name);
  Reader r{document, xml.document_element(), {defines.begin(), defines.end()}};
  std::error_code ignored;
  r.including.push_back(fs::weakly_canonical(fs::path(name), ignored).string());
  if (std::string_view(r.root.name()) != "scene")
    fail(r, source, r.root, "the file's outermost element should be <scene>; is this a Mitsuba scene?");
  document.root = make_node(r, source, r.root);
  read_version(document);
  heed_spelling(r, source);
  read_children(r, source, r.root, document.root, 0);
  for (const auto& [key, value] : defines)
    if (!r.declared.contains(key) && !r.used.contains(key)) {
      r.parameters.erase(key);
      throw Error(
          fmt::format("{}: -D {}: the scene has no parameter of this name; {}", name, key, known_parameters(r)));
    }
  return document;
}

}  // namespace ajar
