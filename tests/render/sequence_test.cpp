// Frames of an animation: whatever fields are carried and whatever numbers frames have in common, each frame is an
// unbiased image; and fields do not depend on threads.
#include "ajar/render/sequence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <span>

#include "ajar/core/error.h"
#include "frames.h"
#include "kit/files.h"
#include "kit/stage.h"

namespace ajar {
namespace {

using namespace kit;

// The usual room with a wall before the lamp, which moves from frame to frame.
Scene room_at(int frame) {
  Scene scene = stage(12);
  add_quad(scene, {-0.8f + 0.3f * float(frame), 0.2f, -0.5f}, {0.9f, 0, 0}, {0, 0.1f, 1},
           add_diffuse(scene, Rgb(0.7f)));
  finish(scene);
  return scene;
}

SequenceOptions usual() {
  SequenceOptions s;
  s.begin = 10, s.teach = 1;
  return s;
}

std::vector<Scene> room_for(int frames) {
  std::vector<Scene> out;
  for (int f = 0; f < frames; ++f) out.push_back(room_at(f));
  return out;
}

Estimate frames_of(const char* integrator, uint32_t passes) {
  RenderOptions options = statistical(integrator);
  options.spp = passes;
  const std::vector<Scene> frames = room_for(3);
  std::vector<std::vector<double>> runs;
  for (uint64_t seed = 1; seed <= 16; ++seed) {
    options.seed = seed;
    const Picture p = last_frame(frames, options, usual());
    runs.emplace_back(p.pixels.begin(), p.pixels.end());
  }
  return estimate(12, 12, std::move(runs));
}

TEST(Sequence, FramesAreUnbiased) {
  const Estimate truth = measure(room_at(2), statistical("path"), {.batches = 16, .passes = 400, .seed = 70});
  expect_same(frames_of("guided-bdpt", 16), truth, "guided-bdpt with carried fields, path");
  expect_same(frames_of("vpl", 8), truth, "vpl with carried fields, path");
}

// Energy: in a furnace every pixel is 1 / (1 - albedo), and most of it passes corners, where joins and walks share.
TEST(Vpl, KeepsEnergyInAFurnace) {
  Material grey;
  grey.reflectance = Rgb(0.7f);
  const Scene scene = furnace(Oven::box, grey);
  for (const char* integrator : {"vpl", "plain-vpl"}) {
    const Estimate e = measure(scene, statistical(integrator), {.batches = 4, .passes = 16, .seed = 3});
    EXPECT_NEAR(mean(e), 1 / 0.3, 0.01 / 0.3) << integrator;
  }
}

// What so narrow a lobe scatters no join will ever find: it is left to walks.
TEST(Vpl, NarrowLobesKeepTheirEnergy) {
  const Scene scene = with_material(MaterialKind::roughdielectric, 0.001f, 12);
  const double right = mean(measure(scene, statistical("path"), {.batches = 4, .passes = 512, .seed = 3}));
  for (const char* integrator : {"vpl", "plain-vpl"}) {
    const double found = mean(measure(scene, statistical(integrator), {.batches = 4, .passes = 64, .seed = 3}));
    EXPECT_NEAR(found / right, 1, 0.015) << integrator;
  }
}

// All that the lens sees is a floor that is lit by way of a wall and a mirror.
Scene lit_by_way_of_a_mirror() {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {0.4f, 1.5f, 1.5f}, {0.4f, 0, 0}, 14, 40, 40);
  const uint32_t white = add_diffuse(scene, Rgb(0.8f)), black = add_diffuse(scene, Rgb(0));
  Material mirror;
  mirror.kind = MaterialKind::conductor;
  add_quad(scene, {0.1f, 0, 0.4f}, {0.6f, 0, 0}, {0, 0, -0.8f}, white);                        // the floor
  add_quad(scene, {-1, 0, 0.5f}, {0, 0, -1}, {0, 1, 0}, white);                                // the wall
  add_quad(scene, {1, 0.1f, -0.3f}, {0, 0, 0.6f}, {0, 0.6f, 0}, add_material(scene, mirror));  // across from it
  add_quad(scene, {-0.1f, -0.1f, -0.6f}, {0, 0, 1.2f}, {0, 0.55f, 0}, black);  // hides the one from the other
  const uint32_t lamp = add_quad(scene, {-0.7f, 0.7f, 0.1f}, {0, 0, -0.2f}, {0, -0.1f, 0}, black);
  add_area_light(scene, lamp, Rgb(50));
  return scene;
}

// Lamps brighter than the one that lights the wall, which face it too, with a screen before them.
void add_hidden_lamps(Scene& scene) {
  const uint32_t black = add_diffuse(scene, Rgb(0));
  for (int i = 0; i < 6; ++i) {
    const float y = 0.9f + 0.1f * float(i);
    add_area_light(scene, add_quad(scene, {-0.6f, y, 0.1f}, {0, 0, -0.2f}, {0, -0.05f, 0}, black), Rgb(100));
  }
  add_quad(scene, {-0.61f, 0.8f, -0.3f}, {0, 0, 0.6f}, {0, 0.8f, 0}, black);
}

// Splats, guided to the mirror, and walks find it, and must agree on each other's densities.
TEST(Vpl, CausticsOfGuidedLightKeepTheirEnergy) {
  Scene scene = lit_by_way_of_a_mirror();
  finish(scene);
  const double right = mean(measure(scene, statistical("path"), {.batches = 4, .passes = 512, .seed = 3}));
  const double found = mean(measure(scene, statistical("vpl"), {.batches = 8, .passes = 64, .seed = 3}));
  EXPECT_NEAR(found / right, 1, 0.04);
}

// The wall is lit by one lamp, and six brighter ones promise as much.
TEST(Vpl, CameraSubpathsLookForLampsThatWereSeen) {
  Scene scene = lit_by_way_of_a_mirror();
  set_camera(scene, {-0.4f, 0.5f, 0}, {-1, 0.5f, 0}, 30, 16, 16);  // at the wall
  add_hidden_lamps(scene);
  finish(scene);
  RenderOptions options = statistical("vpl", 2);
  const auto noise = [&](bool learns) {
    options.learn.lights = learns;
    const Estimate e = measure(scene, options, {.batches = 8, .passes = 8, .seed = 5});
    return std::accumulate(e.variance.begin(), e.variance.end(), 0.0);
  };
  EXPECT_LT(noise(true), 0.5 * noise(false));
}

TEST(Sequence, ImagesNeverDrawTheNumbersThatTaught) {
  SequenceOptions s;
  for (const bool numbers : {true, false}) {
    s.coherence.numbers = numbers;
    for (uint32_t image = 0; image < 50; ++image) {
      EXPECT_EQ(image_seed(s, 5, image) == image_seed(s, 5, 0), numbers || image == 0);
      for (uint32_t teaching = 0; teaching < 50; ++teaching)
        EXPECT_NE(image_seed(s, 5, image), teaching_seed(s, 5, teaching));
      EXPECT_EQ(teaching_seed(s, 5, image) == teaching_seed(s, 5, 0), numbers || image == 0);
    }
  }
}

// Carried or begun, taught with one thread or more: the same image.
TEST(Sequence, DoesNotDependOnThreads) {
  RenderOptions options = statistical("guided-bdpt");
  options.spp = 2, options.sampler = SamplerKind::sobol, options.threads = 1;
  const Picture one = last_frame(room_for(2), options, usual());
  options.threads = 3;
  EXPECT_EQ(last_frame(room_for(2), options, usual()).pixels, one.pixels);
}

TEST(Sequence, CarriedFieldsLearnMore) {
  const Scene scene = room_at(0);
  const Accel accel(scene);
  RenderOptions options = statistical("guided-bdpt");
  SequenceOptions s = usual();
  s.coherence.numbers = false;  // or a lesson would meet the very strata that the one before met
  const Fields begun = *teach(scene, accel, options, s, nullptr, {}, 0, {});
  const Carried carried{0, begun};
  const auto evidence = [](const Fields& f) {
    double sum = 0;
    for (const float w : f.q.weight) sum += double(w);
    return sum;
  };
  // By which cells divide: were it never forgotten, they would until the memory is full, and find no room elsewhere.
  const auto seen = [](const Fields& f) {
    double sum = 0;
    for (const Cell& c : f.cells) sum += double(c.seen);
    return sum;
  };
  s.forget = 0.9f;
  const Fields all = *teach(scene, accel, options, s, &carried, {}, 1, {});
  s.forget = 0.1f;
  const Fields few = *teach(scene, accel, options, s, &carried, {}, 1, {});
  const double kept = evidence(all);
  EXPECT_GT(kept, 1.01 * evidence(few));  // strata that no record reached keep theirs in any case
  EXPECT_NEAR(seen(all) - seen(few), 0.8 * seen(begun), 0.05 * seen(begun));
  // Where all moved there is hardly more left than with nothing kept.
  s.forget = 0.9f;
  const double doubted = evidence(*teach(scene, accel, options, s, &carried, {{Vec3(-9), Vec3(9)}}, 1, {}));
  EXPECT_LT(doubted, 0.6 * kept);
}

// A lamp that is off in the first frame: what later ones teach is not cut to its measure.
TEST(Sequence, LampsMayBeginDark) {
  Scene dark = room_at(0);
  dark.lights[0].radiance = Slot(1e-20f);
  finish(dark);
  const Scene lit = room_at(0);
  const Accel accel(dark);
  const RenderOptions options = statistical("guided-bdpt");
  const Carried first{0, *teach(dark, accel, options, usual(), nullptr, {}, 0, {})};
  ASSERT_LT(first.fields.q.unit, 1e-15);
  const Fields next = *teach(lit, accel, options, usual(), &first, {}, 1, {});
  EXPECT_EQ(next.q.unit, start_fields(lit, 144, options.learn).q.unit);
  float direct = 0;  // what comes from further away takes a lesson for each edge
  for (const FieldCell& c : next.q.cells) direct = std::max(direct, c.direct);
  EXPECT_GT(direct, 0.1f);
}

// What teaches is in no image, so that every pass beyond the lessons would be lost.
TEST(Sequence, TeachesInAsManyPassesAsItSays) {
  const Scene scene = room_at(0);
  const Accel accel(scene);
  const SequenceOptions s = usual();
  for (const char* integrator : {"guided-bdpt", "vpl"}) {
    uint32_t passes = 0;
    const Monitor count = [&](const RenderState& now) {
      EXPECT_FALSE(now.plain.taken) << "path tracing learns nothing";
      passes = std::max(passes, now.film.dropped + now.film.passes - now.learning.first + (now.film.chunks > 0));
      return passes < 100;
    };
    RenderOptions options = statistical(integrator);
    options.leaves_out = true;
    const Fields begun = *teach(scene, accel, options, s, nullptr, {}, 0, count);
    EXPECT_LE(passes, s.begin) << integrator;
    const Carried carried{0, begun};
    passes = 0;
    teach(scene, accel, options, s, &carried, {}, 1, count);
    EXPECT_LE(passes, s.teach + s.teach % 2) << integrator;
  }
}

// With a time limit that is over at once: the fewest lessons, and one short one where fields are carried.
// Lessons of who learns nothing would never end.
TEST(Sequence, TeachesOnlyWhoLearns) {
  const Scene scene = room_at(0);
  const Accel accel(scene);
  const auto refusal = [&](const char* integrator, const SequenceOptions& sequence) {
    return kit::error_of([&] { teach(scene, accel, statistical(integrator), sequence, nullptr, {}, 0, {}); });
  };
  for (const char* integrator : {"path", "bdpt", "photon"}) {
    EXPECT_NE(refusal(integrator, usual()).find("learns no fields"), std::string::npos) << integrator;
    EXPECT_THROW(start_with(scene, statistical(integrator), {}), Error) << integrator;
  }
  SequenceOptions bad = usual();
  bad.forget = 2;
  EXPECT_NE(refusal("guided-bdpt", bad).find("sequence.forget is 2"), std::string::npos);
}

TEST(Sequence, LessonsKeepToTheTime) {
  const Scene scene = room_at(0);
  const Accel accel(scene);
  RenderOptions options = statistical("guided-bdpt");
  const auto lessons = [&](const Carried* before) {
    return teach(scene, accel, options, SequenceOptions{}, before, {}, 0, {})->generation;
  };
  EXPECT_EQ(lessons(nullptr), young_generations + 1);
  options.cpu_seconds = 1e-9;
  const Carried begun{0, *teach(scene, accel, options, SequenceOptions{}, nullptr, {}, 0, {})};
  EXPECT_EQ(begun.fields.generation, blind_generations) << "less would be of no use";
  uint32_t passes = 0;
  SequenceOptions slow;
  slow.teach = 64;
  const Monitor count = [&](const RenderState& now) {
    passes += now.film.chunks == 0;
    return true;
  };
  EXPECT_EQ(teach(scene, accel, options, slow, &begun, {}, 1, count)->generation, blind_generations + 1);
  EXPECT_LE(passes, 2u);
}

// What time cut short in the first frame is made up for, by VPLs too, whose images train for longer.
TEST(Sequence, LessonsCutShortGoOn) {
  const Scene scene = room_at(2);
  const Accel accel(scene);
  for (const char* integrator : {"guided-bdpt", "vpl"}) {
    const RenderOptions options = statistical(integrator);
    Carried carried{0, *teach(scene, accel, options, SequenceOptions{}, nullptr, {}, 0, {})};
    carried.fields.generation = blind_generations + 1;
    for (uint32_t frame = 1; frame < 4; ++frame) {
      carried = {frame, *teach(scene, accel, options, SequenceOptions{}, &carried, {}, frame, {})};
      EXPECT_EQ(carried.fields.generation, blind_generations + 1 + frame) << integrator;
    }
  }
}

// Two closed rooms, each lit by a lamp that shines at the ceiling from behind a screen; the camera is in one of them.
Scene two_sets(float camera_at) {
  Scene scene;
  scene.filter = make_filter(FilterKind::box);
  set_camera(scene, {camera_at, 1, 0.95f}, {camera_at, 1, 0}, 80, 12, 12);
  const uint32_t white = add_diffuse(scene, Rgb(0.7f));
  for (const float x : {0.0f, 8.0f}) {
    add_box(scene, {x - 1, 0, -1}, {x + 1, 2, 1}, white, true);
    add_box(scene, {x - 0.35f, 1.58f, -0.35f}, {x + 0.35f, 1.62f, 0.35f}, white);
    add_area_light(scene, add_quad(scene, {x - 0.15f, 1.63f, 0.15f}, {0.3f, 0, 0}, {0, 0, -0.3f}, white), Rgb(40));
  }
  finish(scene);
  return scene;
}

// Squared and relative to the truth's, without the worst of 144 pixels.
double error_of(const Picture& image, const Picture& truth) {
  std::vector<double> errors;
  for (size_t i = 0; i < truth.pixels.size(); ++i)
    errors.push_back(sqr(double(image.pixels[i]) / double(truth.pixels[i]) - 1));
  std::sort(errors.begin(), errors.end());
  return std::accumulate(errors.begin(), errors.end() - 3, 0.0) / double(errors.size());
}

// After a cut fields know nothing of what the lens sees: one lesson would leave a hundred times the error.
TEST(Sequence, CutsAreTaughtAnew) {
  const Scene here = two_sets(0), there = two_sets(8);
  RenderOptions options = statistical("guided-bdpt");
  options.spp = 256;
  const Picture truth = last_frame(std::span(&there, 1), options, usual());
  options.spp = 8;
  double cut = 0, begun = 0, again = 0;
  for (options.seed = 1; options.seed <= 4; ++options.seed) {
    begun += error_of(last_frame(std::span(&there, 1), options, usual()), truth);
    cut += error_of(last_frame(std::vector{here, here, there}, options, usual()), truth);
    again += error_of(last_frame(std::vector{there, there, there}, options, usual()), truth);
  }
  EXPECT_LT(cut, 2 * begun);
  EXPECT_LT(again, 2 * begun);
}

TEST(Sequence, FilesGiveBackWhatIsCarried) {
  const Scene scene = room_at(0);
  const Accel accel(scene);
  const Carried carried{7, *teach(scene, accel, statistical("guided-bdpt"), usual(), nullptr, {}, 0, {})};
  const std::string path = testing::TempDir() + "ajar_sequence_test.fields";
  save_carried(path, "this", carried);
  const Carried back = load_carried(path, "this");
  EXPECT_EQ(back.frame, 7u);
  EXPECT_EQ(back.fields.q.mean, carried.fields.q.mean);
  EXPECT_EQ(back.fields.w.weight, carried.fields.w.weight);
  EXPECT_THROW(load_carried(path, "that"), Error);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace ajar
