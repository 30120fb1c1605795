#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "ajar/core/error.h"
#include "ajar/render/render.h"

namespace ajar {
namespace {

constexpr char magic[8] = {'A', 'J', 'A', 'R', 'c', 'k', '0', '2'};

// Plain bytes in the order of the fields; the same machine or one of the same byte order reads them.
struct Writer {
  std::ofstream& out;
  void bytes(const void* data, size_t n) { out.write(static_cast<const char*>(data), std::streamsize(n)); }
  template <class T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(&v, sizeof v);
  }
  template <class T>
  void array(const std::vector<T>& v) {
    value(uint64_t(v.size()));
    bytes(v.data(), v.size() * sizeof(T));
  }
};

struct Reader {
  std::ifstream& in;
  uint64_t left;  // bytes of the file that are still to be read: a damaged count must not allocate more
  const std::string& path;
  void bytes(void* data, size_t n) {
    if (n > left || !in.read(static_cast<char*>(data), std::streamsize(n)))
      throw Error(path + ": checkpoint ends too early; it is damaged, start again without --resume");
    left -= n;
  }
  template <class T>
  void value(T& v) {
    bytes(&v, sizeof v);
  }
  template <class T>
  void array(std::vector<T>& v) {
    uint64_t n = 0;
    value(n);
    if (n > left / sizeof(T))
      throw Error(path + ": checkpoint ends too early; it is damaged, start again without --resume");
    v.resize(size_t(n));
    bytes(v.data(), v.size() * sizeof(T));
  }
};

// One list of fields for both ways.
template <class Io, class State>
void film_fields(Io& io, State& film) {
  io.value(film.width), io.value(film.height), io.value(film.passes), io.value(film.chunks);
  io.array(film.camera), io.array(film.splat);
  io.array(film.camera_sum), io.array(film.splat_sum), io.array(film.half_sum), io.array(film.square_sum);
}

}  // namespace

void save_checkpoint(const std::string& path, const std::string& key, const RenderState& state) {
  const std::string aside = path + ".tmp";
  {
    std::ofstream out(aside, std::ios::binary);
    Writer w{out};
    w.bytes(magic, sizeof magic);
    w.array(std::vector<char>(key.begin(), key.end()));
    film_fields(w, state.film);
    w.value(state.stats.counters), w.value(state.stats.rejected), w.value(state.stats.seconds),
        w.value(state.stats.cpu_seconds);
    w.value(uint64_t(state.pyramid.layers.size()));
    for (const auto& [st, layer] : state.pyramid.layers)
      w.value(st.first), w.value(st.second), w.array(layer.raw), w.array(layer.weighted);
    out.flush();
    if (!out) {
      std::filesystem::remove(aside);
      throw Error(path + ": cannot write the checkpoint; is the folder there and the disk not full?");
    }
  }
  std::filesystem::rename(aside, path);
}

void load_checkpoint(const std::string& path, const std::string& key, RenderState& state) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path + ": no such checkpoint; render once with --checkpoint " + path);
  Reader r{in, std::filesystem::file_size(path), path};
  char found[sizeof magic];
  r.bytes(found, sizeof found);
  if (std::memcmp(found, magic, sizeof magic) != 0) throw Error(path + ": not a checkpoint of this version of ajar");
  std::vector<char> stored;
  r.array(stored);
  if (std::string(stored.begin(), stored.end()) != key)
    throw Error(fmt::format("{}: made with another scene or other options; made with: {}", path,
                            std::string(stored.begin(), stored.end())));
  const size_t n = state.film.pixels();
  film_fields(r, state.film);
  r.value(state.stats.counters), r.value(state.stats.rejected), r.value(state.stats.seconds),
      r.value(state.stats.cpu_seconds);
  uint64_t layers = 0;
  r.value(layers);
  for (uint64_t i = 0; i < layers; ++i) {
    std::pair<int, int> st;
    r.value(st.first), r.value(st.second);
    Pyramid::Layer& layer = state.pyramid.layers[st];
    r.array(layer.raw), r.array(layer.weighted);
  }
  const Film& film = state.film;
  const size_t splats = film.splats ? n : 0;
  if (film.pixels() != n || film.camera.size() != n || film.camera_sum.size() != n || film.half_sum.size() != n ||
      film.square_sum.size() != n || film.splat.size() != splats || film.splat_sum.size() != splats ||
      film.chunks >= chunk_count(film))
    throw Error(path + ": checkpoint is damaged, start again without --resume");
}

}  // namespace ajar
