// libFuzzer's entry point for the mesh readers. The first byte chooses the format (0 OBJ, 1 PLY, 2 serialized, 3
// what a serialized mesh compresses, 4 MTL), the second the options; the rest is the file.
#include <cstdio>
#include <cstdlib>

#include "ajar/core/error.h"
#include "mesh_samples.h"
#include "scene/load/mtl.h"

namespace {

ajar::Mesh parse(int format, const std::string& bytes, int shape_index, const ajar::MeshOptions& options) {
  using namespace ajar;
  if (format == 4) return parse_mtl(bytes, "fuzz"), Mesh();
  if (format == 0) return parse_obj(bytes, "fuzz", options);
  if (format == 1) return parse_ply(kit::as_bytes(bytes), "fuzz", options);
  if (format == 2) return parse_serialized(kit::as_bytes(bytes), "fuzz", shape_index, options);
  return parse_serialized(kit::as_bytes(kit::serialized_of({bytes}, 3 + shape_index % 2)), "fuzz", 0, options);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 2) return 0;
  const int choice = data[1];
  ajar::MeshOptions options;
  options.face_normals = choice & 1;
  options.flip_normals = choice & 2;
  options.flip_v = choice & 4;
  if (choice & 8) options.max_smooth_angle = 30;
  if (choice & 16) options.to_world[0][0] = -2;
  options.weld = choice & 32;
  options.apart = choice & 64;
  if (choice & 128) options.group = 1;
  try {
    const std::string bytes(reinterpret_cast<const char*>(data) + 2, size - 2);
    const ajar::Mesh mesh = parse(data[0] % 5, bytes, choice >> 5, options);
    if (const std::string wrong = ajar::kit::unsound(mesh); !wrong.empty()) {
      std::fprintf(stderr, "unsound mesh: %s\n", wrong.c_str());
      std::abort();
    }
  } catch (const ajar::Error&) {
  }
  return 0;
}
