#include "cases.h"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>
#include <iterator>
#include <numbers>

#include "ajar/scene/build.h"

namespace ajar::stress {
namespace {

constexpr int side = 24;

void apply(Scene& scene, const Mat4& m) {
  for (Mesh& mesh : scene.meshes)
    for (Vec3& p : mesh.positions) p = Vec3(m * Vec4(p, 1));
  for (Shape& shape : scene.shapes)
    shape.to_world = m * shape.to_world, shape.to_object = Mat4(glm::inverse(glm::dmat4(shape.to_world)));
}

Scene unlit_room(int width = side, int height = side) {
  Scene scene = cornell(width);
  set_camera(scene, {0, 0, 4.2f}, Vec3(0), 36, width, height);
  for (Shape& shape : scene.shapes) shape.light = none;
  scene.lights.clear();
  return scene;
}

Scene plain_room() { return cornell(side); }

Scene finished(Scene scene) {
  finish(scene);
  return scene;
}

Scene grey_furnace(float albedo) {
  Material wall;
  wall.reflectance = Rgb(albedo);
  return furnace(Oven::box, wall, Rgb(1), 16);
}

// The same image at any size: a room scaled and then moved, seen by a camera that went along.
Scene moved_room(float scale, const Vec3& shift) {
  Scene scene = cornell(side);
  apply(scene, glm::scale(glm::translate(Mat4(1), shift), Vec3(scale)));
  set_camera(scene, shift + Vec3(0, 0, 4.2f * scale), shift, 36, side, side);
  return finished(std::move(scene));
}

// Rooms of 2 x 2 x 2 in a row along x, each joined to the next by a doorway. The light is in the last, the camera in
// the first. Doorways are nearer and farther in turns, or in line: then the camera looks through all of them, since of
// a light that has to go round so many corners nothing would be left.
Scene corridor(int rooms, bool in_line) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  const uint32_t grey = add_diffuse(scene, Rgb(0.8f)), black = add_diffuse(scene, Rgb(0));
  const float length = 2 * float(rooms);
  add_box(scene, {0, 0, 0}, {length, 2, 2}, grey, true);
  for (int i = 1; i < rooms; ++i) {
    const float x = 2 * float(i), z = in_line ? 0.7f : i % 2 ? 0.2f : 1.2f;
    add_box(scene, {x - 0.02f, -0.1f, -0.1f}, {x + 0.02f, 2.1f, z}, grey);
    add_box(scene, {x - 0.02f, -0.1f, z + 0.6f}, {x + 0.02f, 2.1f, 2.1f}, grey);
  }
  add_area_light(scene, add_quad(scene, {length - 1.3f, 1.98f, 0.7f}, {0.6f, 0, 0}, {0, 0, 0.6f}, black), Rgb(20));
  if (in_line)
    set_camera(scene, {0.1f, 1, 1}, {length, 1, 1}, 140 / length, side, side);
  else
    set_camera(scene, {0.1f, 1, 0.5f}, {2, 0.9f, 1}, 70, side, side);
  return finished(std::move(scene));
}

// Two rooms and a wall between them with a door, so far open, of which a gap is all that light finds, in a wall no
// thicker than that. The leaf is 1 m wide; shut, it lies in its frame.
Scene door(double degrees) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  const uint32_t grey = add_diffuse(scene, Rgb(0.7f)), black = add_diffuse(scene, Rgb(0));
  add_box(scene, {0, 0, -2}, {2, 2, 2}, grey, true);
  const float gap = float(std::sin(degrees * std::numbers::pi / 180)), thick = gap > 0 ? std::min(gap, 0.02f) : 0.02f;
  add_box(scene, {-0.1f, -0.1f, -thick}, {0.7f, 2.1f, thick}, grey);
  add_box(scene, {gap > 0 ? 0.7f + gap : 0.6f, -0.1f, -thick}, {2.1f, 2.1f, thick}, grey);
  const float strength = gap > 0 ? 4 / gap : 20;  // so that all images are about as bright
  add_area_light(scene, add_quad(scene, {0.7f, 1.98f, -1.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}, black), Rgb(strength));
  set_camera(scene, {1.8f, 1, 1.8f}, {0.8f, 0.8f, 0}, 70, side, side);
  return finished(std::move(scene));
}

// A second floor so far under the floor: nobody may see it.
Scene false_floor(float gap) {
  Scene scene = cornell(side);
  add_quad(scene, {-1, -1 - gap, 1}, {2, 0, 0}, {0, 0, -2}, add_diffuse(scene, Rgb(0.1f, 0.9f, 0.1f)));
  return finished(std::move(scene));
}

// A lamp so far above the floor, shining up.
Scene floor_lamp(float gap) {
  Scene scene = unlit_room();
  const uint32_t black = add_diffuse(scene, Rgb(0));
  add_area_light(scene, add_quad(scene, {-0.9f, -1 + gap, 0.9f}, {0.6f, 0, 0}, {0, 0, -0.3f}, black), Rgb(10));
  return finished(std::move(scene));
}

// A lamp in a box whose walls are so near to it; nothing may come out.
Scene boxed_lamp(float gap) {
  Scene scene = unlit_room();
  const uint32_t grey = add_diffuse(scene, Rgb(0.8f));
  add_box(scene, Vec3(-0.3f), Vec3(0.3f), grey);
  const uint32_t lamp = add_box(scene, Vec3(-0.3f + gap), Vec3(0.3f - gap), grey);
  add_area_light(scene, lamp, Rgb(100));
  return finished(std::move(scene));
}

// The floor in so many strips along x, as thin as that makes them, with triangles without area among them.
Scene strips(int count) {
  Scene scene = cornell(side);
  Mesh mesh;
  for (int i = 0; i <= count; ++i) {
    const float z = 1 - 2 * float(i) / float(count);
    mesh.positions.push_back({-1, -1, z}), mesh.positions.push_back({1, -1, z});
    if (i == 0) continue;
    const uint32_t k = 2 * uint32_t(i - 1);
    mesh.triangles.push_back({k, k + 1, k + 3}), mesh.triangles.push_back({k, k + 3, k + 2});
    mesh.triangles.push_back({k, k, k + 1}), mesh.triangles.push_back({k, k + 2, k});
  }
  mesh.triangles.push_back({0, 2, 4});
  scene.meshes[scene.shapes[0].mesh] = std::move(mesh);
  return finished(std::move(scene));
}

// The floor in n x n squares.
Scene fine_floor(uint32_t n) {
  Scene scene = cornell(side);
  Mesh mesh;
  for (uint32_t y = 0; y <= n; ++y)
    for (uint32_t x = 0; x <= n; ++x)
      mesh.positions.push_back({-1 + 2 * float(x) / float(n), -1, 1 - 2 * float(y) / float(n)});
  for (uint32_t y = 0; y < n; ++y)
    for (uint32_t x = 0; x < n; ++x) {
      const uint32_t k = y * (n + 1) + x;
      mesh.triangles.push_back({k, k + 1, k + n + 2}), mesh.triangles.push_back({k, k + n + 2, k + n + 1});
    }
  scene.meshes[scene.shapes[0].mesh] = std::move(mesh);
  return finished(std::move(scene));
}

Scene bright_room(float factor) {
  Scene scene = cornell(side);
  for (Light& light : scene.lights) light.radiance.value *= factor;
  return finished(std::move(scene));
}

// The room, lit faintly, and a room beside it, in nobody's sight, lit by so much more.
Scene beside(float bright) {
  Scene scene = bright_room(1e-8f);
  if (bright > 0) {
    add_box(scene, {3, -1, -1}, {5, 1, 1}, add_diffuse(scene, Rgb(0.6f)), true);
    const uint32_t black = add_diffuse(scene, Rgb(0));
    add_area_light(scene, add_quad(scene, {3.6f, 0.98f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, black), Rgb(bright));
  }
  return finished(std::move(scene));
}

// A box of 2 x 2 x 2 without a front, about x, lit from its ceiling.
void add_alcove(Scene& scene, float x, float radiance) {
  const uint32_t grey = add_diffuse(scene, Rgb(0.6f)), black = add_diffuse(scene, Rgb(0));
  add_box(scene, {x - 1.05f, -1.05f, -1.05f}, {x + 1.05f, 1.05f, -1}, grey);
  add_box(scene, {x - 1.05f, -1.05f, -1}, {x + 1.05f, -1, 1}, grey);
  add_box(scene, {x - 1.05f, 1, -1}, {x + 1.05f, 1.05f, 1}, grey);
  add_box(scene, {x - 1.05f, -1, -1}, {x - 1, 1, 1}, grey);
  add_box(scene, {x + 1, -1, -1}, {x + 1.05f, 1, 1}, grey);
  add_area_light(scene, add_quad(scene, {x - 0.4f, 0.98f, -0.4f}, {0.8f, 0, 0}, {0, 0, 0.8f}, black), Rgb(radiance));
}

// Two such boxes in one image, neither of which the other's light comes to.
Scene in_one_image(float faint, float bright) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  add_alcove(scene, -1.1f, faint), add_alcove(scene, 1.1f, bright);
  set_camera(scene, {0, 0, 5}, Vec3(0), 56, 2 * side, side);
  return finished(std::move(scene));
}

// A floor of one triangle and nothing else but a lamp.
Scene one_triangle() {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  Mesh mesh;
  mesh.positions = {{-1, 0, 1}, {1, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 1, 2}};
  add_mesh(scene, std::move(mesh), add_diffuse(scene, Rgb(0.7f)));
  scene.lights[add_light(scene, LightKind::point, Rgb(3))].position = {0.2f, 1, 0.1f};
  set_camera(scene, {0, 1.5f, 2.5f}, Vec3(0), 50, side, side);
  return finished(std::move(scene));
}

// A ball of light of the radius, or the point that it is from afar.
Scene spark(float radius) {
  Scene scene = unlit_room();
  const Vec3 place(0.1f, 1.2f, 1.8f);  // out of sight
  if (radius > 0) {
    const float radiance = 3 / (pi * radius * radius);
    add_area_light(scene, add_sphere(scene, place, radius, add_diffuse(scene, Rgb(0))), Rgb(radiance));
  } else {
    scene.lights[add_light(scene, LightKind::point, Rgb(3))].position = place;
  }
  return finished(std::move(scene));
}

// The room fills the film's height.
Scene film(int width, int height) {
  Scene scene = cornell(side);
  const float half = std::tan(18 * pi / 180) * std::min(1.0f, float(width) / float(height));
  set_camera(scene, {0, 0, 4.2f}, Vec3(0), 2 * std::atan(half) * 180 / pi, width, height);
  return finished(std::move(scene));
}

// A ball or a box of glass before a sky of radiance 1: it cannot be seen.
Scene glass_in_sky(float ior, bool box) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  const uint32_t glass = add_example(scene, MaterialKind::dielectric);
  scene.materials[glass].ior = ior;
  if (box)
    add_box(scene, glm::rotate(Mat4(1), 0.5f, glm::normalize(Vec3(1, 2, 3))), glass);
  else
    add_sphere(scene, Vec3(0), 1, glass);
  add_light(scene, LightKind::constant, Rgb(1));
  set_camera(scene, {0, 0, 4}, Vec3(0), 45, side, side);
  return finished(std::move(scene));
}

Camera parallel(const Vec3& eye, const Vec3& target, float half) {
  Camera c;
  c.kind = CameraKind::orthographic;
  c.to_world = look_at(eye, target), c.to_camera = Mat4(glm::inverse(glm::dmat4(c.to_world)));
  c.plane = Vec2(half);
  set_size(c, side, side);
  return c;
}

// A bar of glass, cut at 45 degrees at both ends, before a lamp of radiance 1. What comes in through one end, straight,
// is thrown between the sides by total internal reflection, 2 hops + 1 times, and leaves through the other; no hops: a
// pane. Parts go to and fro between the ends, and of all of it 2n / (n^2 + 1) arrives.
Scene glass_bar(float ior, int hops) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  const uint32_t glass = add_example(scene, MaterialKind::dielectric), black = add_diffuse(scene, Rgb(0));
  scene.materials[glass].ior = ior;
  const float end = 2 * float(hops) + 2;
  if (hops == 0) {
    add_box(scene, {-2, -2, -0.3f}, {2, 2, 0.3f}, glass);
    add_area_light(scene, add_quad(scene, {-2, -2, -1}, {4, 0, 0}, {0, 4, 0}, black), Rgb(1));
    scene.camera = parallel({0, 0, 3}, Vec3(0), 0.5f);
    return finished(std::move(scene));
  }
  Mesh bar;
  for (const float z : {-1.0f, 1.0f})
    bar.positions.insert(bar.positions.end(), {{0, 0, z}, {end, 0, z}, {end - 1, 1, z}, {1, 1, z}});
  bar.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (const uint32_t a : {0u, 1u, 2u, 3u}) {
    const uint32_t b = (a + 1) % 4;
    bar.triangles.push_back({a, b, b + 4}), bar.triangles.push_back({a, b + 4, a + 4});
  }
  add_mesh(scene, std::move(bar), glass);
  add_area_light(scene, add_quad(scene, {end + 1, 0.5f, -1.5f}, {0, 0, 3}, {-1.5f, 1.5f, 0}, black), Rgb(1));
  scene.camera = parallel({-1.5f, 2.5f, 0}, {0.5f, 0.5f, 0}, 0.4f);
  return finished(std::move(scene));
}

// Glass balls between mirrors under a sky of radiance 1; nothing scatters diffusely.
Scene deltas_in_sky() {
  Scene scene = glass_in_sky(1.5f, false);
  Material mirror;
  mirror.kind = MaterialKind::conductor;
  mirror.eta = Rgb(0), mirror.k = Rgb(1);
  const uint32_t silver = add_material(scene, mirror);
  add_quad(scene, {-1.5f, -3, 3}, {0, 0, -6}, {0, 6, 0}, silver);
  add_quad(scene, {1.5f, -3, -3}, {0, 0, 6}, {0, 6, 0}, silver);
  for (float y = -1.2f; y < 2; y += 2.4f) add_sphere(scene, {0.2f, y, 0.3f}, 0.5f, scene.shapes[0].material);
  return finished(std::move(scene));
}

Scene black_room() {
  Scene scene = cornell(side);
  for (Material& m : scene.materials) m.reflectance = Rgb(0);
  return finished(std::move(scene));
}

// Along the floor from just above it. bumps: 0 none.
Scene grazing(float height, float bumps) {
  Scene scene = bumps > 0 ? bump_plane(false, side) : cornell(side);
  for (Material& m : scene.materials)
    if (m.kind == MaterialKind::bumpmap) m.map_scale = bumps;
  set_camera(scene, {0, -1 + height, 0.95f}, {0.1f, -1 + height * 0.7f, -1}, 40, side, side);
  return finished(std::move(scene));
}

std::string shown(double x) { return fmt::format("{:g}", x); }

struct List {
  std::vector<Case> all;
  std::string group;
  Case& add(std::string name, std::function<Scene()> make) {
    all.push_back({group, std::move(name), std::move(make)});
    return all.back();
  }
};

void add_stiff(List& l) {
  l.group = "closed box";
  for (const double a : {0.5, 0.9, 0.99, 0.999}) {
    Case& c = l.add("albedo " + shown(a), [a] { return grey_furnace(float(a)); });
    c.answer = 1 / (1 - double(float(a)));
    if (a > 0.95) c.passes = 3;
  }
  Case& edges = l.add("albedo 1, 16 edges", [] { return grey_furnace(1); });
  edges.answer = 16, edges.max_depth = 16;
  Case& endless = l.add("albedo 1, no limit", [] { return grey_furnace(1); });
  endless.judge.clear(), endless.passes = 2;
  l.group = "corridor";
  for (const int n : {1, 3, 6}) l.add(fmt::format("{} rooms", n), [n] { return corridor(n, false); }).judge = "bdpt";
  Case& fifty = l.add("50 rooms, doors in line", [] { return corridor(50, true); });
  fifty.judge = "bdpt", fifty.faint = 1e-3;
  l.group = "door";
  for (const double d : {20.0, 5.0, 1.0, 0.1, 0.01}) {
    Case& c = l.add(shown(d) + " degrees", [d] { return door(d); });
    c.judge = "bdpt";
    c.light = d > 0.5;  // one path in millions gets through, and meets the lens
    if (d < 2) c.passes = 64;
  }
  l.add("shut", [] { return door(0); }).answer = 0;
}

void add_sizes(List& l) {
  const auto plain = plain_room;
  l.group = "size";
  l.add("x 1", plain);
  for (const double s : {1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6})
    l.add("x " + shown(s), [s] { return moved_room(float(s), Vec3(0)); }).twin = plain;
  l.group = "far away";
  l.add("at the origin", plain);
  for (const double d : {1e2, 1e3, 1e4, 1e5, 1e6}) {
    Case& c = l.add(shown(d) + " room widths", [d] { return moved_room(1, Vec3(1.2f, -0.7f, 1) * float(d)); });
    c.twin = plain, c.limit = d > 5e4;
  }
  l.group = "close surfaces";
  l.add("no second floor", plain);
  for (const double g : {1e-2, 1e-4, 1e-6, 1e-7})
    l.add("a second floor " + shown(g) + " below", [g] { return false_floor(float(g)); }).twin = plain;
  for (const double g : {1e-4, 1e-6})
    l.add("lamp " + shown(g) + " above the floor", [g] { return floor_lamp(float(g)); }).twin = [] {
      return floor_lamp(1e-3f);
    };
  for (const double g : {1e-2, 1e-4, 1e-5, 1e-6}) {
    Case& c = l.add("box " + shown(g) + " around the lamp", [g] { return boxed_lamp(float(g)); });
    c.answer = 0, c.limit = g < 5e-6;
  }
  l.group = "triangles";
  l.add("12 a box", plain);
  l.add("one", one_triangle);
  for (const int n : {1000, 100000})
    l.add(fmt::format("{} slivers 1:{}", 2 * n, n), [n] { return strips(n); }).twin = plain;
  for (const uint32_t n : {70u, 700u, 2200u}) {
    Case& c = l.add(fmt::format("{:.0e}", 2.0 * n * n), [n] { return fine_floor(n); });
    c.twin = plain, c.large = n > 1000;
  }
}

void add_lights(List& l) {
  const auto plain = plain_room;
  l.group = "radiance";
  l.add("x 1", plain);
  for (const double f : {1e-12, 1e-6, 1e6, 1e12}) {
    Case& c = l.add("x " + shown(f), [f] { return bright_room(float(f)); });
    c.twin = plain, c.factor = double(float(f));
  }
  Case& both = l.add("1e-8 beside 1e8", [] { return beside(1e8f); });
  both.twin = [] { return beside(0); };
  both.light = false;                    // it begins at lamps as they have power: once in 1e16 at the faint one
  both.blind = {"photon", "plain-vpl"};  // so do these
  Case& seen = l.add("1e-8 and 1e8 in one image", [] { return in_one_image(1e-8f, 1e8f); });
  seen.light = false, seen.blind = both.blind;
  l.group = "lights";
  l.add("1", [] { return many_lights(1, 1, side); });
  for (const int n : {100, 100000}) l.add(fmt::format("{}", n), [n] { return many_lights(n, 1, side); });
  l.add("none", [] { return finished(unlit_room()); }).answer = 0;
  l.add("one that is black", [] { return bright_room(0); }).answer = 0;
  for (const double r : {1e-3, 1e-6}) {
    Case& c = l.add("ball of radius " + shown(r), [r] { return spark(float(r)); });
    c.twin = [] { return spark(0); }, c.passes = 32;
  }
  l.group = "film";
  l.add("24 x 24", plain);
  Case& dot = l.add("1 x 1", [] { return film(1, 1); });
  dot.passes = 1000, dot.blind = {"photon"};  // merges with one light subpath
  for (const bool wide : {true, false}) {
    Case& c = l.add(wide ? "4096 x 1" : "1 x 4096", [wide] { return wide ? film(4096, 1) : film(1, 4096); });
    c.passes = 2;
    c.light = !wide;  // hardly a path from the lamp crosses so thin an image
    c.tails = wide;   // nor is there more than a photon or two in a block of it
  }
}

void add_materials(List& l) {
  for (const auto& [kind, what] :
       {std::pair(MaterialKind::roughconductor, "rough metal"), std::pair(MaterialKind::roughdielectric, "rough glass"),
        std::pair(MaterialKind::roughplastic, "rough plastic")}) {
    l.group = what;
    for (const double a : {0.3, 1.0, 0.1, 0.01, 1e-3, 1e-4}) {
      Case& c = l.add("roughness " + shown(a), [kind = kind, a] { return with_material(kind, float(a), side); });
      c.light = a >= 0.1;
      if (!c.light) c.blind = {"photon"};  // a photon in 1/alpha^2 comes from within the lobe
    }
  }
  l.group = "glass in a white sky";
  for (const bool box : {false, true})
    for (const double n : {1.5, 1.0001, 1.01, 3.0}) {
      Case& c = l.add(fmt::format("{} of index {:g}", box ? "box" : "ball", n),
                      [n, box] { return glass_in_sky(float(n), box); });
      c.answer = 1, c.light = false;
    }
  Case& deltas = l.add("glass and mirrors alone", deltas_in_sky);
  deltas.answer = 1, deltas.light = false;
  l.group = "glass before a lamp";
  for (const double n : {1.5, 1.0001, 1.01, 3.0}) {
    Case& c = l.add(fmt::format("pane of index {:g}", n), [n] { return glass_bar(float(n), 0); });
    c.answer = 2 * n / (n * n + 1), c.light = false;
  }
  for (const int hops : {1, 32}) {
    Case& c = l.add(fmt::format("{} total reflections", 2 * hops + 1), [hops] { return glass_bar(1.5f, hops); });
    c.answer = 3 / 3.25, c.light = false;
  }
  l.group = "chain of mirrors";
  for (const int n : {1, 16, 64}) l.add(fmt::format("{}", n), [n] { return mirror_chain(n, side); }).light = false;
  l.group = "surfaces";
  l.add("grey", plain_room);
  l.add("black", black_room);
  for (const double h : {1e-2, 1e-4, 1e-6}) {
    Case& c = l.add("seen from " + shown(h) + " above", [h] { return grazing(float(h), 0); });
    c.light = h > 1e-3;                  // what lies so close to the lens, no path from a lamp will meet
    if (!c.light) c.blind = {"photon"};  // radii are as large as pixels look: here they vanish
  }
  for (const double b : {0.08, 1.0}) {
    Case& c = l.add("bumps of " + shown(b) + " from 0.01 above", [b] { return grazing(1e-2f, float(b)); });
    c.tails = b > 0.5;  // steep bumps reach the lens: a light subpath that comes so near it is rare, and bright
  }
}

}  // namespace

std::vector<Case> cases() {
  List l;
  add_stiff(l);
  add_sizes(l);
  add_lights(l);
  add_materials(l);
  std::vector<Case> learning = learning_cases();
  std::move(learning.begin(), learning.end(), std::back_inserter(l.all));
  return std::move(l.all);
}

}  // namespace ajar::stress
