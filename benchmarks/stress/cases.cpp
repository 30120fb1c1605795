#include "cases.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "ajar/scene/build.h"
#include "scenes.h"

namespace ajar::stress {
namespace {

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
    c.answer = (1 - std::pow(double(float(a)), deepest)) / (1 - double(float(a)));  // paths end there (limits.md)
    if (a > 0.95) c.passes = a > 0.995 ? 9 : 3;
  }
  Case& edges = l.add("albedo 1, 16 edges", [] { return grey_furnace(1); });
  edges.answer = 16, edges.max_depth = 16;
  Case& endless = l.add("albedo 1, no limit", [] { return grey_furnace(1); });
  endless.judge.clear(), endless.passes = 2;
  l.group = "corridor";
  for (const int n : {1, 3, 6}) {
    Case& c = l.add(fmt::format("{} rooms", n), [n] { return corridor(n, false); });
    c.judge = "bdpt";
    if (n == 6) c.passes = 64;
  }
  Case& fifty = l.add("50 rooms, doors in line", [] { return corridor(50, true); });
  fifty.judge = "bdpt", fifty.faint = 1e-3;
  l.group = "door";
  for (const double d : {20.0, 5.0, 1.0, 0.1, 0.01}) {
    Case& c = l.add(shown(d) + " degrees", [d] { return door(d); });
    c.judge = "bdpt";
    c.light = d > 0.5;  // one path in millions gets through, and meets the lens
    c.passes = d < 0.05 ? 512 : 64;
    if (d < 0.05) c.blind = {"photon"};  // too bright (limits.md)
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
  l.add("one", one_triangle).passes = 64;  // photons are few on it
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
  l.add("1", [] { return many_lights(1, 1, image_side); });
  for (const int n : {100, 100000}) l.add(fmt::format("{}", n), [n] { return many_lights(n, 1, image_side); });
  l.add("none", [] { return dark_room(); }).answer = 0;
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
    c.passes = 10;
    c.light = false;  // hardly a path from the lamp crosses so thin an image
    c.tails = true;   // nor is there more than a photon or two in a block of it
  }
}

void add_materials(List& l) {
  for (const auto& [kind, what] :
       {std::pair(MaterialKind::roughconductor, "rough metal"), std::pair(MaterialKind::roughdielectric, "rough glass"),
        std::pair(MaterialKind::roughplastic, "rough plastic")}) {
    l.group = what;
    for (const double a : {0.3, 1.0, 0.1, 0.01, 1e-3, 1e-4}) {
      Case& c = l.add("roughness " + shown(a), [kind = kind, a] { return with_material(kind, float(a), image_side); });
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
    Case& c = l.add(fmt::format("pane of index {:g}", n), [n] { return glass_pane(float(n)); });
    c.answer = 2 * n / (n * n + 1), c.light = false;
  }
  for (const int hops : {1, 32}) {
    Case& c = l.add(fmt::format("{} total reflections", 2 * hops + 1), [hops] { return glass_bar(1.5f, hops); });
    c.answer = 3 / 3.25, c.light = false;
  }
  l.group = "chain of mirrors";
  for (const int n : {1, 16, 64})
    l.add(fmt::format("{}", n), [n] { return mirror_chain(n, image_side); }).light = false;
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
