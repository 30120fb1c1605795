// Roulette on arrival keeps what a camera subpath brings in the mean, and ends what others bring as well.
#include "ajar/path/arrival.h"

#include "bytes.h"

namespace ajar {
namespace {

// Camera subpaths of a scene whose fields are learned, each with the ray's walk, at every vertex where they arrive.
// visit says whether they go on.
template <class Visit>
void at_arrivals(const Scene& scene, const Accel& accel, const WalkOptions& options, int paths, const Visit& visit) {
  Subpath camera;
  for (int i = 0; i < paths; ++i) {
    Sampler sampler = make_sampler(SamplerKind::independent, 7, Side::camera, uint64_t(i), 0);
    Walk walk;
    const Vec2 raster = sampler.next2() * Vec2(scene.camera.width, scene.camera.height);
    start_camera(scene, raster, sampler.next2(), camera, walk);
    Surface surface;
    while (camera.n < 8 && step(scene, accel, options, camera, walk, surface)) {
      if (!visit(camera, walk, sampler) || !scatter(options, sampler, camera, walk)) break;
    }
  }
}

TEST(Arrival, KeepsTheMeanAndEndsWhatJoinsBeforeBring) {
  const Scene scene = two_rooms(20);
  const Accel accel(scene);
  const RenderState state = rendered(scene, accel, options_of("guided-bdpt", 24));
  WalkOptions options;
  options.fields = &state.learning.fields;
  options.counts = {.light_paths = 500, .inner = 2, .seen = 1000};
  WalkOptions easier = options;
  easier.goes_on = Balance::most;
  int ended[9] = {}, tried[9] = {}, saved = 0;
  double before = 0, after = 0, square = 0;
  at_arrivals(scene, accel, options, 4000, [&](const Subpath& camera, const Walk& walk, Sampler&) {
    Subpath copy = camera;
    Walk gone_on = walk;
    Sampler sampler =
        make_sampler(SamplerKind::independent, 8, Side::camera, uint64_t(tried[camera.n]), uint32_t(camera.n));
    const float was = luminance(camera[camera.n - 1].beta);
    const bool on = is_worth_it(options, sampler, copy, gone_on);
    if (on) {
      EXPECT_EQ(gone_on.sure, walk.sure && luminance(copy[copy.n - 1].beta) == was);
    }
    Subpath other = camera;
    Walk other_walk = walk;
    Sampler same =
        make_sampler(SamplerKind::independent, 8, Side::camera, uint64_t(tried[camera.n]), uint32_t(camera.n));
    const bool easily = is_worth_it(easier, same, other, other_walk);
    EXPECT_LE(on, easily);
    saved += easily && !on;
    const double is = on ? double(luminance(copy[copy.n - 1].beta)) : 0;
    ++tried[camera.n], ended[camera.n] += !on;
    before += double(was), after += is, square += sqr(is - double(was));
    return true;
  });
  EXPECT_NEAR(after, before, 4 * std::sqrt(square));
  EXPECT_GT(std::sqrt(square), 1) << "some end";
  EXPECT_LT(std::sqrt(square), 0.03 * before);
  EXPECT_GT(saved, 0) << "where more are to go on (G16)";
  EXPECT_EQ(ended[2], 0) << "what the lens sees is not joined before";
  EXPECT_GT(10 * ended[3], tried[3]);
}

// Between bright walls all that comes later is found by others as well, vertex after vertex: chances of a fifth each
// would leave a light of 1 in 5^n subpaths, 5^n times as bright.
TEST(Arrival, RaisesNoThroughputBeyondTheWindow) {
  Material wall;
  wall.reflectance = Rgb(0.95f);
  const Scene scene = furnace(Oven::box, wall, Rgb(1), 8);
  const Accel accel(scene);
  const RenderState state = rendered(scene, accel, options_of("guided-bdpt", 24));
  WalkOptions options;
  options.fields = &state.learning.fields;
  options.counts = {.light_paths = 64, .inner = 2, .seen = 10};
  float highest = 0;
  int arrived = 0;
  at_arrivals(scene, accel, options, 2000, [&](Subpath& camera, Walk& walk, Sampler& sampler) {
    const float before = max_component(walk.survival);
    ++arrived;
    if (!is_worth_it(options, sampler, camera, walk)) return false;
    const float after = max_component(walk.survival);
    EXPECT_LE(after, std::max(1.001f * options.window, before)) << "what guiding raised is left as it is";
    if (after > before) highest = std::max(highest, after);
    return true;
  });
  EXPECT_GT(arrived, 4000);
  EXPECT_GT(highest, 0.9f * options.window) << "it is reached";
}

}  // namespace
}  // namespace ajar
