#include "entities.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "ajar/core/error.h"
#include "node.h"

namespace ajar {
namespace {

constexpr std::string_view white_space = " \t\r\n";
constexpr size_t max_open_entities = 32, max_references = 100'000, max_bytes = size_t(1) << 26;

struct Entity {
  std::string text, file;
  bool is_read = true;  // false: the file has still to be
};

struct Expansion {
  const std::string &folder, &name;
  std::map<std::string, Entity, std::less<>> entities;
  std::vector<std::string_view> open;  // being put in
  std::string out;
  size_t references = 0, added = 0;
  size_t line = 1;  // of the file's own text

  [[noreturn]] void fail(std::string_view entity, const std::string& what) const {
    throw Error(fmt::format("{}:{}: the entity &{}; {}", name, line, entity.substr(0, 80), what));
  }
};

struct Cursor {
  std::string_view rest;

  bool take(std::string_view word) {
    if (!rest.starts_with(word)) return false;
    rest.remove_prefix(word.size());
    return true;
  }
  void skip_blanks() { rest.remove_prefix(std::min(rest.find_first_not_of(white_space), rest.size())); }
  // What stands before the mark, which is passed too; all that is left where there is none.
  std::string_view until(std::string_view mark) {
    const size_t at = rest.find(mark);
    const std::string_view before = rest.substr(0, at);
    rest.remove_prefix(at == rest.npos ? rest.size() : at + mark.size());
    return before;
  }
  bool skip_comment() {
    if (take("<!--")) return until("-->"), true;
    if (take("<?")) return until("?>"), true;
    return false;
  }
  std::string_view word() {
    skip_blanks();
    const std::string_view w = rest.substr(0, rest.find_first_of(" \t\r\n\"'<>[]%&;"));
    rest.remove_prefix(w.size());
    return w;
  }
  std::optional<std::string_view> quoted() {
    if (!rest.starts_with('"') && !rest.starts_with('\'')) return {};
    const std::string_view mark = rest.substr(0, 1);
    rest.remove_prefix(1);
    return until(mark);
  }
  // To one of the marks, but for those in quotes.
  void skip_to(std::string_view marks) {
    while (!rest.empty() && marks.find(rest.front()) == marks.npos)
      if (!quoted()) rest.remove_prefix(1);
  }
};

// After <!ENTITY, and up to something before its end: a name and its text or file. Those of parameters (%) and of other
// data (NDATA) are passed over.
void read_entity(Cursor& in, Expansion& e) {
  const std::string name(in.word());
  if (name.empty()) return;
  in.skip_blanks();
  if (const auto text = in.quoted()) {
    e.entities.emplace(name, Entity{std::string(*text), "", true});  // the first one counts
    return;
  }
  const std::string_view kind = in.word();
  in.skip_blanks();
  if (kind == "PUBLIC") in.quoted(), in.skip_blanks();
  if (kind != "PUBLIC" && kind != "SYSTEM") return;
  const auto file = in.quoted();
  if (file && in.word() != "NDATA") e.entities.emplace(name, Entity{"", std::string(*file), false});
}

// Up to the end of the DOCTYPE, where there is one.
void read_doctype(Cursor& in, Expansion& e) {
  in.rest = without_mark(in.rest);
  for (in.skip_blanks(); in.skip_comment(); in.skip_blanks()) {
  }
  if (!in.take("<!DOCTYPE")) return;
  in.skip_to("[>");
  if (!in.take("[")) return;
  for (in.skip_blanks(); !in.rest.empty() && !in.take("]"); in.skip_blanks()) {
    if (in.skip_comment()) continue;
    const bool declares = in.take("<!");
    if (declares && in.take("ENTITY")) read_entity(in, e);
    if (declares) in.skip_to(">");
    in.rest.remove_prefix(std::min<size_t>(1, in.rest.size()));
  }
}

void read_entity_file(Expansion& e, const std::string& name, Entity& entity) {
  const std::filesystem::path path = std::filesystem::path(e.folder) / entity.file;
  try {
    entity.text = without_mark(read_text(path.string()));
  } catch (const Error& error) {
    e.fail(name, fmt::format("cannot be put in: {}", error.what()));
  }
  entity.is_read = true;
}

void expand(Expansion& e, std::string_view text);

void put_in(Expansion& e, std::string_view name) {
  const auto found = e.entities.find(name);
  if (found == e.entities.end()) e.fail(name, "is declared in no DOCTYPE");
  if (std::find(e.open.begin(), e.open.end(), name) != e.open.end()) e.fail(name, "contains itself");
  if (e.open.size() >= max_open_entities) e.fail(name, fmt::format("is nested more than {} deep", max_open_entities));
  if (++e.references > max_references) e.fail(name, fmt::format("makes more than {} references", max_references));
  Entity& entity = found->second;
  if (!entity.is_read) read_entity_file(e, found->first, entity);
  e.added += entity.text.size();
  if (e.added > max_bytes) e.fail(name, fmt::format("makes the file grow by more than {} MB", max_bytes >> 20));
  e.open.push_back(found->first);
  expand(e, entity.text);
  e.open.pop_back();
}

bool is_predefined(std::string_view name) {
  return name == "lt" || name == "gt" || name == "amp" || name == "quot" || name == "apos" || name.starts_with('#');
}

void copy(Expansion& e, std::string_view text) {
  e.out += text;
  if (e.open.empty())
    e.line += size_t(std::count(text.begin(), text.end(), '\n'));
  else
    std::replace_if(
        e.out.end() - ptrdiff_t(text.size()), e.out.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
}

void expand(Expansion& e, std::string_view text) {
  Cursor in{text};
  while (!in.rest.empty()) {
    const std::string_view before = in.rest;
    if (in.skip_comment() || (in.take("<![CDATA[") && (in.until("]]>"), true))) {
      copy(e, before.substr(0, before.size() - in.rest.size()));
      continue;
    }
    if (in.take("&")) {
      const std::string_view name = in.word();
      if (!name.empty() && !is_predefined(name) && in.take(";")) {
        put_in(e, name);
        continue;
      }
      in.rest = before;
    }
    const size_t length = std::min(in.rest.find_first_of("<&", 1), in.rest.size());
    copy(e, in.rest.substr(0, length));
    in.rest.remove_prefix(length);
  }
}

}  // namespace

std::string expand_entities(const std::string& text, const std::string& folder, const std::string& name) {
  if (text.find('&') == text.npos) return text;
  Expansion e{folder, name, {}, {}, {}, 0, 0, 1};
  Cursor in{text};
  read_doctype(in, e);
  const size_t head = text.size() - in.rest.size();
  e.out.reserve(text.size());
  copy(e, std::string_view(text).substr(0, head));
  expand(e, in.rest);
  return std::move(e.out);
}

}  // namespace ajar
