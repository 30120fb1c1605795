#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>

#include "ajar/core/error.h"
#include "mesh.h"

namespace ajar {
namespace {

static_assert(std::endian::native == std::endian::little);

// The layout is documented with Mitsuba's shape plugin "serialized".
constexpr uint16_t magic = 0x041c;
constexpr size_t header_size = 4;  // magic and version, the only parts of a mesh that are not compressed
enum Flags : uint32_t {
  has_normals = 0x1,
  has_uvs = 0x2,
  has_colors = 0x8,
  single_precision = 0x1000,
  double_precision = 0x2000
};

// A file, of which no more is read than is asked for: it may hold thousands of meshes, each read on its own. Or bytes
// in memory.
struct Pieces {
  size_t size = 0;
  std::function<std::span<const std::byte>(size_t at, size_t count)> piece;  // within the size; until the next one
  std::string name;                                                          // for messages
};

Pieces pieces_of(std::span<const std::byte> bytes, const std::string& name) {
  return {bytes.size(), [bytes](size_t at, size_t count) { return bytes.subspan(at, count); }, name};
}

Pieces open_pieces(const std::string& path) {
  const auto file = std::make_shared<std::ifstream>(open_bytes(path));
  const auto buffer = std::make_shared<std::vector<std::byte>>();
  file->seekg(0, std::ios::end);
  return {size_t(std::max<std::streamoff>(file->tellg(), 0)),
          [=](size_t at, size_t count) -> std::span<const std::byte> {
            buffer->resize(count);
            file->seekg(std::streamoff(at));
            if (!file->read(reinterpret_cast<char*>(buffer->data()), std::streamsize(count)))
              throw Error(path + ": cannot be read to its end; is it being written?");
            return *buffer;
          },
          path};
}

template <class T>
T load(const Pieces& source, size_t at) {
  T out;
  std::memcpy(&out, source.piece(at, sizeof(T)).data(), sizeof(T));
  return out;
}

// Inflates piece by piece, so that counts which lie cost no more memory than the data there really is.
struct Inflater {
  z_stream stream{};
  const Pieces& source;
  size_t next;  // byte of the source
  const std::string& name = source.name;

  Inflater(const Pieces& from, size_t at) : source(from), next(at) {
    if (inflateInit(&stream) != Z_OK) throw Error(name + ": zlib cannot start; is there enough memory?");
  }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
  ~Inflater() { inflateEnd(&stream); }

  void feed() {
    constexpr size_t most = 1 << 16;
    if (stream.avail_in > 0 || next == source.size) return;
    const auto piece = source.piece(next, std::min(source.size - next, most));
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(piece.data()));
    stream.avail_in = uInt(piece.size());
    next += piece.size();
  }

  void read(void* to, size_t n) {
    auto* out = static_cast<Bytef*>(to);
    while (n > 0) {
      feed();
      const uInt wanted = uInt(std::min<size_t>(n, 1u << 30));
      stream.next_out = out, stream.avail_out = wanted;
      const int result = inflate(&stream, Z_NO_FLUSH);
      const size_t got = wanted - stream.avail_out;
      out += got, n -= got;
      if (n == 0) break;
      if (result == Z_DATA_ERROR || result == Z_NEED_DICT || result == Z_MEM_ERROR)
        throw Error(fmt::format("{}: the compressed data are damaged ({}); copy the file anew", name,
                                stream.msg ? stream.msg : "zlib"));
      if (result == Z_STREAM_END || (got == 0 && stream.avail_in == 0 && next == source.size))
        throw Error(name + ": the compressed data end before the mesh does; is the file whole?");
    }
  }

  template <class T>
  T value() {
    T out;
    read(&out, sizeof(T));
    return out;
  }

  // count items of N numbers each, stored as Stored, appended as T.
  template <class Stored, class T, int N>
  void array(std::vector<T>& out, size_t count) {
    constexpr size_t piece = 16384;
    std::vector<Stored> buffer(std::min(count, piece) * N);
    out.reserve(std::min<size_t>(count, 1u << 16));
    for (size_t done = 0; done < count;) {
      const size_t n = std::min(count - done, piece);
      read(buffer.data(), n * N * sizeof(Stored));
      out.resize(done + n);
      for (size_t i = 0; i < n; ++i)
        for (int k = 0; k < N; ++k) out[done + i][k] = typename T::value_type(buffer[i * N + size_t(k)]);
      done += n;
    }
  }

  template <class T, int N>
  void array(std::vector<T>& out, size_t count, bool doubles) {
    doubles ? array<double, T, N>(out, count) : array<float, T, N>(out, count);
  }
};

uint16_t check_header(const Pieces& source, size_t at) {
  const std::string& name = source.name;
  if (at + header_size > source.size) throw Error(name + ": too short for a serialized mesh; is the file whole?");
  if (load<uint16_t>(source, at) != magic)
    throw Error(fmt::format(
        "{}: no serialized mesh at byte {} (0x041c is expected there); is it a serialized file, and whole?", name, at));
  const uint16_t version = load<uint16_t>(source, at + 2);
  if (version != 3 && version != 4)
    throw Error(fmt::format("{}: serialized format {}; versions 3 and 4 are supported", name, version));
  return version;
}

// Where a mesh starts, from the dictionary at the end of the file; the first one starts at 0 by definition.
size_t find_mesh(const Pieces& source, uint16_t version, int shape_index) {
  const std::string& name = source.name;
  if (shape_index < 0) throw Error(fmt::format("{}: shape_index {} is negative; they count from 0", name, shape_index));
  if (shape_index == 0) return 0;
  const size_t width = version == 4 ? 8 : 4, index = size_t(shape_index);
  const size_t count = load<uint32_t>(source, source.size - 4);
  if (count > (source.size - 4) / width) throw Error(name + ": no dictionary of meshes at the end; is the file whole?");
  if (index >= count)
    throw Error(fmt::format("{}: shape_index {}, but the file holds {} meshes (0 to {})", name, shape_index, count,
                            int64_t(count) - 1));
  const size_t dictionary = source.size - 4 - count * width, entry = dictionary + index * width;
  const uint64_t offset = version == 4 ? load<uint64_t>(source, entry) : load<uint32_t>(source, entry);
  if (offset + header_size > dictionary || offset > source.size)
    throw Error(fmt::format("{}: mesh {} starts at byte {}, beyond the last", name, shape_index, offset));
  return size_t(offset);
}

void skip_name(Inflater& in) {
  for (int length = 0; in.value<char>() != 0; ++length)
    if (length == 1 << 16) throw Error(in.name + ": a mesh name of more than 64 KiB; the file is damaged");
}

Mesh read_mesh(const Pieces& source, int shape_index, const MeshOptions& options) {
  const std::string& name = source.name;
  const size_t start = find_mesh(source, check_header(source, 0), shape_index);
  const uint16_t own_version = check_header(source, start);
  Inflater in(source, start + header_size);
  const uint32_t flags = in.value<uint32_t>();
  const bool doubles = flags & double_precision;
  if (doubles == bool(flags & single_precision))
    throw Error(fmt::format("{}: flags {:#x} say neither or both of single and double precision", name, flags));
  if (own_version == 4) skip_name(in);
  const uint64_t vertices = in.value<uint64_t>(), triangles = in.value<uint64_t>();
  // Beyond this the format's indices are 64 bits wide, and a Mesh's are not.
  if (vertices >= none || triangles >= none)
    throw Error(
        fmt::format("{}: {} vertices, {} triangles; at most 2^32 - 2 are supported", name, vertices, triangles));

  Mesh mesh;
  in.array<Vec3, 3>(mesh.positions, vertices, doubles);
  if (flags & has_normals) in.array<Vec3, 3>(mesh.normals, vertices, doubles);
  if (flags & has_uvs) in.array<Vec2, 2>(mesh.uvs, vertices, doubles);
  if (flags & has_colors) in.array<Rgb, 3>(mesh.colors, vertices, doubles);
  in.array<uint32_t, glm::uvec3, 3>(mesh.triangles, triangles);
  complete(mesh, options, fmt::format("{} (mesh {})", name, shape_index));
  return mesh;
}

}  // namespace

Mesh parse_serialized(std::span<const std::byte> bytes, const std::string& name, int shape_index,
                      const MeshOptions& options) {
  return read_mesh(pieces_of(bytes, name), shape_index, options);
}

Mesh read_serialized(const std::string& path, int shape_index, const MeshOptions& options) {
  return read_mesh(open_pieces(path), shape_index, options);
}

}  // namespace ajar
