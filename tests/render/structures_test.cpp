// Every structure, rule and way of training leaves the image right, and learns what the others learn.
#include <gtest/gtest.h>

#include "kit/stage.h"
#include "measure.h"

namespace ajar {
namespace {

using namespace kit;

Scene room() {
  Scene scene = stage();
  Material glossy;
  glossy.kind = MaterialKind::roughplastic;
  add_sphere(scene, {0.15f, -0.35f, 0.1f}, 0.45f, add_material(scene, glossy));
  finish(scene);
  return scene;
}

struct Way {
  const char* name;
  const char* integrator;
  void (*set)(RenderOptions&);
};
void PrintTo(const Way& w, std::ostream* out) { *out << w.name; }

const Way ways[] = {
    {"grid", "guided-bdpt", [](RenderOptions& o) { o.learn.structure = Structure::grid; }},
    {"probes", "guided-bdpt", [](RenderOptions& o) { o.learn.structure = Structure::probes; }},
    {"grid_path", "guided-path", [](RenderOptions& o) { o.learn.structure = Structure::grid; }},
    {"probes_path", "guided-path", [](RenderOptions& o) { o.learn.structure = Structure::probes; }},
    {"max", "guided-bdpt", [](RenderOptions& o) { o.learn.rule = Rule::max; }},
    {"returned", "guided-bdpt", [](RenderOptions& o) { o.learn.rule = Rule::returned; }},
    {"trained", "guided-bdpt", [](RenderOptions& o) { o.learn.train = 6, o.learn.forget = 1; }},
    {"no_next_event", "path", [](RenderOptions& o) { o.next_event = false; }},
    {"no_next_event_guided", "guided-path", [](RenderOptions& o) { o.next_event = false; }},
};

class Ways : public testing::TestWithParam<Way> {};

TEST_P(Ways, LeaveTheImageRight) {
  const Scene scene = room();
  RenderOptions o = statistical("bdpt", 6);
  const Estimate bdpt = measure(scene, o, {.batches = 16, .passes = 24, .seed = 1000});
  o.integrator = GetParam().integrator;
  GetParam().set(o);
  o.learn.trust = 8;  // few paths guide as many will
  expect_same(measure(scene, o, {.batches = 16, .passes = o.next_event ? 24u : 60u, .seed = 2000}), bdpt,
              GetParam().name);
}

INSTANTIATE_TEST_SUITE_P(All, Ways, testing::ValuesIn(ways),
                         [](const auto& test) { return std::string(test.param.name); });

// Fields from elsewhere keep their structure, whatever the options say of fields that start from nothing.
TEST(Structures, OnlyAdaptiveCellsAreCutAlongWalls) {
  const Scene scene = room();
  const Accel accel(scene);
  for (const Structure structure : {Structure::adaptive, Structure::grid}) {
    RenderOptions o = statistical("guided-bdpt", 6);
    o.spp = 2;
    o.learn.structure = structure;
    RenderState state = start_render(scene, o);
    o.learn.structure = Structure::adaptive;
    render(scene, accel, o, state, {});
    EXPECT_EQ(state.learning.fields.table.compartments.empty(), structure == Structure::grid);
  }
}

// What measure() stands on.
TEST(Structures, WallsAreThoseOfAnyRender) {
  Scene scene = two_rooms(30);
  set_size(scene.camera, 16, 9);
  const Accel accel(scene);
  RenderOptions o = statistical("guided-bdpt", 5);
  o.spp = 6, o.seed = 1;
  const RenderState other = rendered(scene, accel, o);
  o.seed = 2;
  const CellTable& walls = other.learning.fields.table;
  ASSERT_FALSE(walls.cuts.empty());
  ASSERT_FALSE(walls.portals.empty());
  EXPECT_EQ(develop(rendered(scene, accel, o).film).pixels, develop(rendered(scene, accel, o, &walls).film).pixels);
}

// An image that ends among them is made of those pixels that were traced, which stand for the others.
TEST(BlindPasses, TraceSomePixelsOfLargeImages) {
  const Scene scene = cornell(128);
  const Accel accel(scene);
  RenderOptions o = statistical("guided-bdpt");
  o.spp = 3;
  const RenderState state = rendered(scene, accel, o);
  EXPECT_EQ(state.film.dropped, 0u);
  EXPECT_NEAR(double(state.stats.counters.camera_paths), 128 * 128 * (0.25 + 0.25 + 0.5), 500);
  const double truth = mean(measure(scene, statistical("bdpt"), {4, 3}));
  for (const char* integrator : {"guided-path", "guided-bdpt", "guided-vcm"})
    EXPECT_NEAR(mean(measure(scene, statistical(integrator), {8, 3})) / truth, 1, 0.02) << integrator;
}

// Green of a picture, or its means over tiles of so many pixels a side.
std::vector<double> tiles_of(const Picture& picture, int side) {
  const int columns = (picture.width + side - 1) / side;
  std::vector<double> out(size_t(columns * ((picture.height + side - 1) / side)));
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      out[size_t(y / side * columns + x / side)] +=
          double(picture.pixels[size_t(3 * (y * picture.width + x) + 1)]) / (side * side);
  return out;
}

// Relative variance over pictures: the median over the picture.
double spread(const std::vector<Picture>& pictures, int side) {
  std::vector<double> sum, square, found;
  for (const Picture& picture : pictures) {
    const std::vector<double> tiles = tiles_of(picture, side);
    sum.resize(tiles.size()), square.resize(tiles.size());
    for (size_t i = 0; i < tiles.size(); ++i) sum[i] += tiles[i], square[i] += tiles[i] * tiles[i];
  }
  for (size_t i = 0; i < sum.size(); ++i)
    if (sum[i] > 0) found.push_back(square[i] / (sum[i] * sum[i]) - 1 / double(pictures.size()));
  std::nth_element(found.begin(), found.begin() + ptrdiff_t(found.size() / 2), found.end());
  return found[found.size() / 2];
}

// A light vertex that stands for too much makes grain, not tiles: neighbouring pixels join other ones. (J10)
TEST(Pools, PixelsOfATileHardlyErrTogether) {
  const Scene scene = two_rooms(40, 96);
  const Accel accel(scene);
  RenderOptions o = statistical("guided-bdpt");
  o.spp = 8;
  std::vector<Picture> pictures;
  for (; pictures.size() < 3; ++o.seed) pictures.push_back(develop(rendered(scene, accel, o).film));
  const double together = spread(pictures, 16) * 16 * 16 / spread(pictures, 1);
  EXPECT_LT(together, 40) << "64 where the pixels of a row of tiles share a pool";
}

// Irradiance (or importance) that camera (light) vertices see on average, as the cells know it. Cells of one size.
double mean_total(const std::vector<Fields>& renders, Side side) {
  double sum = 0, weights = 0;
  for (const Fields& fields : renders)
    for (const FieldCell& cell : fields.of(side).cells) sum += double(cell.visits * cell.total), weights += cell.visits;
  return sum / weights;
}

// The same of what their strata hold alone, without what next-event estimation (the lens) brings the cells themselves.
double mean_of_strata(const std::vector<Fields>& renders, Side side) {
  double sum = 0, weights = 0;
  for (const Fields& fields : renders)
    for (const FieldCell& cell : fields.of(side).cells)
      sum += double(cell.visits * (cell.total - cell.direct)), weights += cell.visits;
  return sum / weights;
}

// By three seeds, whose means differ by a tenth.
std::vector<Fields> learned(const Scene& scene, Structure structure, Rule rule) {
  RenderOptions o = statistical("guided-bdpt");
  o.spp = 32, o.learn.structure = structure, o.learn.rule = rule;
  o.learn.memory = size_t(5) << 20;  // so few cells that all of them are visited
  std::vector<Fields> out;
  for (; out.size() < 3; ++o.seed) out.push_back(rendered(scene, Accel(scene), o).learning.fields);
  return out;
}

TEST(Structures, LearnTheSame) {
  const Scene scene = room();
  const auto grid = learned(scene, Structure::grid, Rule::expected),
             probes = learned(scene, Structure::probes, Rule::expected),
             returned = learned(scene, Structure::grid, Rule::returned),
             max = learned(scene, Structure::grid, Rule::max);
  for (const Side side : {Side::camera, Side::light}) {
    const double truth = mean_total(grid, side);
    // Their cells end elsewhere, so that paths guided by them go to somewhat different places.
    EXPECT_NEAR(mean_total(probes, side), truth, 0.2 * truth);
    // A light path's return sees the lens from its own vertices alone, the other rules from camera vertices too.
    EXPECT_NEAR(mean_total(returned, side), truth, 0.2 * truth);
    EXPECT_GT(mean_of_strata(returned, side), 0.3 * mean_of_strata(grid, side));
    EXPECT_GT(mean_total(max, side), 1.5 * truth) << "max exaggerates";
  }
}

bool same(const RenderState& a, const RenderState& b) {
  return a.film.camera_sum == b.film.camera_sum && a.film.splat_sum == b.film.splat_sum &&
         a.learning.fields.q.mean == b.learning.fields.q.mean && a.learning.fields.w.mean == b.learning.fields.w.mean;
}

TEST(Structures, ThreadsDoNotMatter) {
  const Scene scene = room();
  const Accel accel(scene);
  for (const Structure structure : {Structure::grid, Structure::probes})
    for (const Rule rule : {Rule::expected, Rule::returned}) {
      RenderOptions o = statistical("guided-bdpt");
      o.spp = 2, o.learn.structure = structure, o.learn.rule = rule, o.threads = 1;
      const RenderState one = rendered(scene, accel, o);
      o.threads = 3;
      EXPECT_TRUE(same(one, rendered(scene, accel, o))) << structure_names[size_t(structure)];
      ++o.seed;
      EXPECT_FALSE(same(one, rendered(scene, accel, o)));
    }
}

TEST(Train, FreezesTheFields) {
  const Scene scene = room();
  const Accel accel(scene);
  RenderOptions o = statistical("guided-path");
  o.learn.train = 3, o.spp = 2;  // passes are dropped in pairs: 4
  const RenderState first = rendered(scene, accel, o);
  o.spp = 20;
  const RenderState later = rendered(scene, accel, o);
  EXPECT_EQ(later.learning.fields.generation, 4u);
  EXPECT_EQ(later.film.dropped, 4u);
  EXPECT_EQ(later.film.passes, 20u);
  EXPECT_EQ(first.film.passes, 2u) << "after the training";
  EXPECT_EQ(first.learning.fields.q.mean, later.learning.fields.q.mean);
  o.learn.train = 0;
  EXPECT_GT(rendered(scene, accel, o).learning.fields.generation, young_generations);
}

}  // namespace
}  // namespace ajar
