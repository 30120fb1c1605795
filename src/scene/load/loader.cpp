#include "loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "ajar/core/bytes.h"
#include "ajar/core/error.h"

namespace ajar {

namespace {

constexpr size_t max_open_plugins = 48;  // a plugin in a plugin in a plugin ...

// In pieces: a mesh may be large.
uint64_t checksum_of_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<char> piece(size_t(1) << 20);
  uint64_t sum = 0, size = 0;
  while (in) {
    in.read(piece.data(), std::streamsize(piece.size()));
    sum = checksum(piece.data(), size_t(in.gcount()), sum);
    size += uint64_t(in.gcount());
  }
  return checksum(&size, sizeof size, sum);
}

LoadCache::Stamp stamp_of(const std::string& path) {
  std::error_code unknown;
  return {std::filesystem::file_size(path, unknown), std::filesystem::last_write_time(path, unknown)};
}

[[noreturn]] void fail_changed(const std::string& path) {
  throw Error(path + ": has changed since the animation began; give the command again");
}

// The checksum of a file that no load has met before. Its stamp is older than what is read.
uint64_t sum_of_new(Loader& loader, const Node& node, const std::string& path) {
  const LoadCache::Stamp stamp = stamp_of(path);
  std::array<char, 40> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  if (const std::string problem = pointer_problem({head.data(), head.size()}); !problem.empty())
    fail(loader, node, path + problem);
  const uint64_t sum = checksum_of_file(path);
  if (loader.cache) loader.cache->files.emplace(path, LoadCache::File{stamp, sum});
  return sum;
}

}  // namespace

void count_text(Document& document, const std::string& text) {
  const uint64_t size = text.size();
  document.sums.push_back(checksum(text.data(), text.size(), size));
  document.content = checksum(text.data(), text.size(), checksum(&size, sizeof size, document.content));
}

void count_file(Loader& loader, const Node& node, const std::string& path) {
  auto known = loader.sums.find(path);
  if (known == loader.sums.end()) {
    const auto* cache = loader.cache;
    const bool kept = cache && cache->files.contains(path);
    known = loader.sums.emplace(path, kept ? cache->files.at(path).sum : sum_of_new(loader, node, path)).first;
  }
  loader.scene.content = checksum(&known->second, sizeof known->second, loader.scene.content);
}

void check_texts(const Document& document, bool with_first, LoadCache& cache) {
  for (size_t i = with_first ? 0 : 1; i < document.files.size(); ++i)
    if (cache.texts.emplace(document.files[i], document.sums[i]).first->second != document.sums[i])
      fail_changed(document.files[i]);
}

void check_unchanged(const Loader& loader) {
  if (!loader.cache) return;
  for (const auto& [path, sum] : loader.sums) {
    LoadCache::File& file = loader.cache->files.at(path);
    const LoadCache::Stamp now = stamp_of(path);
    if (now == file.stamp) continue;
    if (checksum_of_file(path) != file.sum) fail_changed(path);
    file.stamp = now;  // written anew as it was
  }
}

void fail(const Loader& loader, const Node& node, const std::string& text) {
  throw Error(place(loader.document, node) + ": " + text);
}

void note(Loader& loader, const Node& node, const std::string& text) {
  const std::string what = fmt::format("<{} {}> {}", node.tag, node.type.empty() ? node.name : node.type, text);
  if (loader.said.insert(what).second)
    loader.scene.notes.push_back(one_line(place(loader.document, node) + ": " + text));
}

std::string unknown(const Node& node) { return node.type.empty() ? "has no type" : "unknown " + node.tag; }

void unsupported(Loader& loader, const Node& node, const std::string& text, const std::string& instead) {
  if (!loader.lenient) fail(loader, node, text + "; with --lenient: " + instead);
  note(loader, node, text + ": " + instead);
}

const Node& follow(const Loader& loader, const Node& node) {
  if (node.tag != "ref") return node;
  if (node.id.empty()) fail(loader, node, "needs id=\"...\"");
  std::string id = node.id;
  for (size_t steps = 0;; ++steps) {
    const auto alias = loader.document.aliases.find(id);
    if (alias == loader.document.aliases.end()) break;
    if (steps > loader.document.aliases.size())
      fail(loader, node, "its <alias> goes in a circle; let one of them name an element");
    id = alias->second.id;
  }
  const auto found = loader.ids.find(id);
  if (found == loader.ids.end())
    fail(loader, node,
         fmt::format("nothing in the scene has the id \"{}\"; correct it, or add what it names", shortened(id)));
  return *found->second;
}

Open::Open(Loader& l, const Node& node) : loader(l) {
  if (std::find(loader.open.begin(), loader.open.end(), &node) != loader.open.end())
    fail(loader, node, "contains itself; take away the reference that leads back to it");
  if (loader.open.size() >= max_open_plugins)
    fail(loader, node, fmt::format("plugins are nested more than {} deep; leave some out", max_open_plugins));
  loader.open.push_back(&node);
}

}  // namespace ajar
