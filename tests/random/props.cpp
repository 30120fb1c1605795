#include <cmath>
#include <fstream>

#include "ajar/film/picture.h"
#include "grammar.h"
#include "kit/stage.h"

namespace ajar::random {
namespace {

Picture picture(int width, int height) {
  return {width, height, {"R", "G", "B"}, std::vector<float>(size_t(3) * size_t(width) * size_t(height))};
}

Picture speckled(uint64_t seed, double a, double b) {
  Dice dice(seed);
  Picture p = picture(8, 8);
  for (float& v : p.pixels) v = float(dice.between(a, b));
  return p;
}

Picture normals() {
  Picture p = speckled(2, 0.27, 0.73);
  for (size_t i = 2; i < p.pixels.size(); i += 3) p.pixels[i] = 0.86f;
  return p;
}

// Few bright texels on dark ones.
Picture uneven(int width, int height) {
  Dice dice(3);
  Picture p = picture(width, height);
  for (float& v : p.pixels) v = 8 * float(std::pow(dice.between(0, 1), 4));
  return p;
}

// A bright upper half with a sun in it.
Picture sky() {
  Picture p = picture(32, 16);
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const bool sun = (x == 9 || x == 10) && (y == 3 || y == 4);
      const float value = sun ? 40 : y < 9 ? 0.2f + float((x * 7 + y * 3) % 5) * 0.3f : 0.02f;
      float* pixel = p.pixels.data() + 3 * (y * p.width + x);
      pixel[0] = value, pixel[1] = 0.8f * value, pixel[2] = 0.5f * value + 0.1f;
    }
  return p;
}

void write_ply(const std::string& path, const Mesh& mesh) {
  std::ofstream out(path);
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.positions.size() << '\n';
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "u", "v"}) out << "property float " << name << '\n';
  out << "element face " << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3 p = mesh.positions[i], n = mesh.normals[i];
    out << fmt::format("{:g} {:g} {:g} {:g} {:g} {:g} {:g} {:g}\n", p.x, p.y, p.z, n.x, n.y, n.z, mesh.uvs[i].x,
                       mesh.uvs[i].y);
  }
  for (const auto& t : mesh.triangles) out << fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
}

// A sheet over [-1, 1]^2 with waves.
void write_sheet(const std::string& path) {
  constexpr int n = 6;
  std::ofstream out(path);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
      out << fmt::format("v {:g} {:g} {:g}\nvt {:g} {:g}\n", x, y, 0.2 * std::sin(4 * x) * std::cos(3 * y),
                         double(i) / n, double(j) / n);
      out << fmt::format("vn {:g} {:g} 1\n", -0.8 * std::cos(4 * x) * std::cos(3 * y),
                         0.6 * std::sin(4 * x) * std::sin(3 * y));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j + 1, b = a + n + 1;
      out << fmt::format("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", a, b, a + 1);
      out << fmt::format("f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\n", a + 1, b, b + 1);
    }
}

}  // namespace

void write_props(const std::string& folder) {
  write_png(folder + "/albedo.png", speckled(1, 0, 1));
  write_exr(folder + "/bump.exr", speckled(4, 0, 1));
  write_exr(folder + "/normal.exr", normals());
  write_exr(folder + "/lamp.exr", uneven(8, 4));
  write_exr(folder + "/sky.exr", sky());
  write_ply(folder + "/globe.ply", kit::globe(Vec3(0), 1, 8));
  write_ply(folder + "/bent.ply", kit::globe(Vec3(0), 1, 7, 0.3f));
  write_sheet(folder + "/sheet.obj");
}

}  // namespace ajar::random
