// What integrators see of scenes that nobody thought of: the same, in every block. AJAR_RANDOM_SCENES=FROM-TO has other
// numbers than the few that are tried here.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "ajar/scene/load.h"
#include "grammar.h"
#include "render/bytes.h"

namespace ajar {
namespace {

using random::Dice;
using random::RandomScene;

// A folder of props, as long as the tests run.
struct Props {
  std::filesystem::path folder;
  Props() : folder(std::filesystem::temp_directory_path() / fmt::format("ajar-random-{}", getpid())) {
    std::filesystem::create_directories(folder);
    random::write_props(folder.string());
  }
  ~Props() { std::filesystem::remove_all(folder); }
};

class Agreement : public testing::TestWithParam<uint64_t> {
 protected:
  static void SetUpTestSuite() { props = std::make_unique<Props>(); }
  static void TearDownTestSuite() { props.reset(); }

  const RandomScene made = random::random_scene(GetParam());
  const Scene scene = load_scene_text(made.xml, props->folder.string(), "random.xml");

 private:
  static inline std::unique_ptr<Props> props;
};

std::vector<std::string> able(const random::Kinds& kinds) {
  std::vector<std::string> out = {"guided-bdpt", "vpl", "plain-vpl"};
  if (!kinds.point_lights || !kinds.deltas) out.insert(out.end(), {"path", "guided-path"});
  if (!kinds.deltas && !kinds.sky) out.push_back("light");
  return out;
}

RenderOptions drawn(Dice& dice, const std::string& integrator, int max_depth) {
  RenderOptions o = statistical(integrator, max_depth);
  o.heuristic = dice.any({Heuristic::power, Heuristic::power, Heuristic::balance});
  o.roulette_depth = dice.any({5, 5, 2, 20});
  o.learn.structure = dice.any({Structure::adaptive, Structure::adaptive, Structure::grid, Structure::probes});
  o.learn.rule = dice.any({Rule::expected, Rule::expected, Rule::returned});
  o.learn.guided = dice.any({Guided::both, Guided::both, Guided::camera, Guided::light});
  o.learn.train = dice.any({0u, 0u, 0u, 4u});
  o.learn_lights = (integrator == "path" || integrator == "bdpt") && dice.chance(0.3);
  return o;
}

std::string told(const RenderOptions& o) {
  return fmt::format("{} (heuristic {}, roulette {}, structure {}, rule {}, guided {}, train {}, lights {})",
                     o.integrator, int(o.heuristic), o.roulette_depth, int(o.learn.structure), int(o.learn.rule),
                     int(o.learn.guided), o.learn.train, o.learn_lights);
}

// A difference that a quick look suspects has to be there in a longer one, of other numbers, too.
TEST_P(Agreement, InEveryBlock) {
  SCOPED_TRACE(made.noted + '\n' + made.xml);
  const int max_depth = scene.hints.max_depth;
  const kit::Slack slack{.faint = 1e-3};  // what a filter's corners show, hardly a camera's sample
  Dice dice(~GetParam());
  const auto look = [&](const RenderOptions& o, uint32_t effort, uint64_t seed) {
    const uint32_t passes = o.integrator == "path" || o.integrator == "light" ? 60 : 20;
    return measure(scene, o, {.batches = 12, .passes = passes * effort, .seed = seed});
  };
  const RenderOptions plain = statistical("bdpt", max_depth);
  const kit::Estimate bdpt = look(plain, 1, 1);
  uint64_t seed = 0;
  for (const std::string& integrator : able(made.kinds)) {
    const RenderOptions o = drawn(dice, integrator, max_depth);
    seed += 1000;
    if (kit::z_test(look(o, 1, seed), bdpt, 1e-2, 3, slack).ok) continue;
    const kit::Estimate again = look(o, 8, seed + 500), right = look(plain, 8, 500);
    const kit::ZTest z = kit::z_test(again, right, 1e-5, 3, slack);
    std::fprintf(stderr, "%s, bdpt: %g, %g, %s\n", told(o).c_str(), mean(again), mean(right), z.message.c_str());
    EXPECT_TRUE(z.ok) << told(o);
  }
}

// Whoever renders with two threads, and goes on from a checkpoint at each look, has the image of one thread that was
// let be.
TEST_P(Agreement, StopsAndThreadsDoNotMatter) {
  const Accel accel(scene);
  Dice dice(GetParam() + 1000000);
  const std::vector<std::string> names = tried_integrators();
  RenderOptions o = drawn(dice, names[size_t(dice.below(int(names.size())))], scene.hints.max_depth);
  o.sampler = SamplerKind::sobol;
  o.spp = 5;
  o.techniques = has_strategies(o.integrator) && dice.chance(0.5);
  o.limit_fireflies = dice.chance(0.3);
  o.final_gather = o.integrator == "photon" ? dice.any({0, 4}) : 0;
  o.threads = 1;
  SCOPED_TRACE(told(o) + ", " + made.noted + '\n' + made.xml);
  const RenderState straight = rendered(scene, accel, o);
  o.threads = 2;
  const File file("ajar-random-checkpoint");
  RenderState state = start_render(scene, o);
  do {
    render(scene, accel, o, state, [](const RenderState&) { return false; });
    save_checkpoint(file.path, "key", state);
    state = start_render(scene, o);
    load_checkpoint(file.path, "key", state);
  } while (in_training(state.learning) || state.film.passes < o.spp);
  expect_same_bytes(straight, state);
}

std::vector<uint64_t> numbers() {
  uint64_t from = 1, to = 6;
  if (const char* asked = std::getenv("AJAR_RANDOM_SCENES")) {
    const std::string range = asked;
    from = std::stoull(range);
    to = range.find('-') == std::string::npos ? from : std::stoull(range.substr(range.find('-') + 1));
  }
  std::vector<uint64_t> out;
  for (uint64_t i = from; i <= to; ++i) out.push_back(i);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Random, Agreement, testing::ValuesIn(numbers()),
                         [](const auto& test) { return std::to_string(test.param); });

}  // namespace
}  // namespace ajar
