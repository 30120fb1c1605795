#include "ajar/report/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "ajar/film/picture.h"
#include "ajar/report/curves.h"
#include "ajar/report/json.h"
#include "markup.h"
#include "pack.h"
#include "page_parts.h"
#include "planes.h"

namespace ajar {
namespace {

using nlohmann::json;

constexpr int small_width = 160;  // of an (s,t) image on the page

/// What goes into the page beside the results: an index of the files by their names in the results, and an element for
/// each.
struct Embedded {
  json index = json::object();
  std::string elements;
};

std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  const bool has_bytes = file.peek() != std::ifstream::traits_type::eof();  // << of none would be a failure
  if (has_bytes) bytes << file.rdbuf();
  if (!file.is_open() || file.bad() || bytes.fail())
    throw Error(fmt::format("{}: cannot be read; check its permissions", path.string()));
  return bytes.str();
}

struct Embedder {
  std::filesystem::path dir;
  Embedded out;

  /// Where the file is; throws Error where it is not.
  std::string find(const std::string& name, const std::string& where) const {
    const std::filesystem::path path = dir / name;
    if (!is_file(path.string()))
      throw Error(
          fmt::format("{}: there is no such file, but {} in {} names it; run the bench again, or take it out there",
                      path.string(), where, (dir / "results.json").string()));
    return path.string();
  }

  void element(const std::string& name, json entry, const std::string& text) {
    const size_t id = out.index.size();
    entry["id"] = fmt::format("file-{}", id);
    out.index[name] = std::move(entry);
    out.elements += fmt::format("<script type=\"text/plain\" id=\"file-{}\">{}</script>\n", id, text);
  }

  /// most_width: of the picture on the page; 0 for all of it.
  void hdr(const json& name, const std::string& where, int most_width) {
    if (name.is_null() || out.index.contains(name.get<std::string>())) return;
    Picture picture = read_rgb(find(name, where));
    if (most_width > 0) picture = reduced(picture, most_width);
    const Packed packed = pack(picture);
    element(name, {{"width", picture.width}, {"height", picture.height}, {"exponent", packed.exponent}}, packed.text);
  }

  void png(const json& name, const std::string& where) {
    if (name.is_null() || out.index.contains(name.get<std::string>())) return;
    const std::string path = find(name, where), bytes = read_bytes(path);
    if (!bytes.starts_with("\x89PNG")) throw Error(fmt::format("{}: is no PNG file; write it as one", path));
    element(name, {{"png", true}}, base64({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}));
  }
};

/// The element if it is there, else null.
const json& at(const json& object, const char* key) {
  static const json null;
  const auto found = object.find(key);
  return found == object.end() ? null : *found;
}

void require_same_size(const Embedder& embedder, const json& image, const json& reference) {
  if (image.is_null() || reference.is_null()) return;
  const json &a = embedder.out.index[image.get<std::string>()], &b = embedder.out.index[reference.get<std::string>()];
  if (a["width"] == b["width"] && a["height"] == b["height"]) return;
  throw Error(fmt::format("{}: has {}x{} pixels, its reference {} has {}x{}; render both in one size",
                          (embedder.dir / image.get<std::string>()).string(), a["width"].get<int>(),
                          a["height"].get<int>(), reference.get<std::string>(), b["width"].get<int>(),
                          b["height"].get<int>()));
}

void embed_method(Embedder& embedder, const json& method, const json& reference, const std::string& where) {
  embedder.hdr(at(method, "image"), where + ".image", 0);
  require_same_size(embedder, at(method, "image"), reference);
  size_t i = 0;
  for (const json& technique : at(method, "techniques")) {
    const std::string element = fmt::format("{}.techniques[{}]", where, i++);
    embedder.hdr(at(technique, "weighted"), element + ".weighted", small_width);
    embedder.hdr(at(technique, "raw"), element + ".raw", small_width);
  }
  i = 0;
  for (const json& field : at(method, "fields"))
    embedder.png(at(field, "image"), fmt::format("{}.fields[{}].image", where, i++));
}

Embedded embed(const json& results, const std::filesystem::path& dir) {
  Embedder embedder{dir, {}};
  size_t s = 0;
  for (const json& scene : results.at("scenes")) {
    const std::string where = fmt::format("scenes[{}]", s++);
    const json reference = at(scene, "reference").is_null() ? json() : at(scene["reference"], "image");
    embedder.hdr(reference, where + ".reference.image", 0);
    size_t m = 0;
    for (const json& method : at(scene, "methods"))
      embed_method(embedder, method, reference, fmt::format("{}.methods[{}]", where, m++));
  }
  return std::move(embedder.out);
}

/// JSON that can stand in a script element: no "<", which alone could end or change it.
std::string inline_json(const json& value) {
  std::string out;
  for (const char c : value.dump(-1, ' ', false, json::error_handler_t::replace)) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

/// Replaces each "{{NAME}}" of the text once; what is put in is not looked at again.
std::string filled(std::string_view text, const std::map<std::string, std::string, std::less<>>& parts) {
  std::string out;
  for (size_t at = 0; at < text.size();) {
    const size_t open = text.find("{{", at), close = text.find("}}", open);
    if (close == std::string_view::npos) return out += text.substr(at);
    out += text.substr(at, open - at);
    out += parts.at(std::string(text.substr(open + 2, close - open - 2)));
    at = close + 2;
  }
  return out;
}

}  // namespace

void write_report(const json& results, const std::filesystem::path& dir) {
  const std::string file = (dir / "results.json").string();
  Embedded embedded;
  std::string title, curves;
  try {
    if (const json& format = results.at("format"); format != 1)
      throw Error(fmt::format("{}: format is {}, this version reads 1; use the version that wrote it, {}", file,
                              format.dump(), results.value("version", "which it does not name")));
    title = results.value("title", "");
    embedded = embed(results, dir);
    curves = curves_svg(results);
  } catch (const json::exception&) {
    throw Error(fmt::format("{}: is not what a bench writes; run the bench again", file));
  }
  write_text((dir / "report.html").string(),
             filled(page::html, {{"title", escaped(title)},
                                 {"style", std::string(page::style)},
                                 {"results", inline_json(results)},
                                 {"files", inline_json(embedded.index)},
                                 {"images", embedded.elements},
                                 {"script", fmt::format("{}", fmt::join(page::scripts, ""))}}));
  std::error_code ignored;
  if (curves.empty())
    std::filesystem::remove(dir / "curves.svg", ignored);  // of other results
  else
    write_text((dir / "curves.svg").string(), curves);
}

json read_results(const std::filesystem::path& dir) {
  const std::filesystem::path path = dir / "results.json";
  std::error_code none_such;
  if (!std::filesystem::is_regular_file(path, none_such))
    throw Error(fmt::format("{}: {}; name the folder that ajar bench wrote", path.string(),
                            none_such ? none_such.message() : "is no file"));
  return read_json(path, "run the bench again");
}

}  // namespace ajar
