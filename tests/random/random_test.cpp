// What integrators see of scenes that nobody thought of: the same, in every block. AJAR_RANDOM_SCENES=FROM-TO has other
// numbers than the few that are tried here.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "ajar/scene/load.h"
#include "grammar.h"
#include "render/bytes.h"
#include "render/frames.h"

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
  const LightChoice choice =
      Dice(GetParam() + 3000000)
          .any({LightChoice::tree, LightChoice::tree, LightChoice::tree, LightChoice::uniform, LightChoice::power});
  const Scene scene = at("0");

  /// Of the place where $shift puts what moves.
  Scene at(const char* shift) const {
    Scene loaded = load_scene_text(made.xml, props->folder.string(), "random.xml", {.defines = {{"shift", shift}}});
    set_light_choice(loaded, choice);
    return loaded;
  }
  /// Options of an integrator, and what they are.
  RenderOptions drawn(Dice& dice, const std::string& integrator) const;
  std::string told(const RenderOptions& o) const;

 private:
  static inline std::unique_ptr<Props> props;
};

std::vector<std::string> able(const random::Kinds& kinds) {
  std::vector<std::string> out = {"guided-bdpt", "vpl", "plain-vpl"};
  if (!kinds.point_lights || !kinds.deltas) out.insert(out.end(), {"path", "guided-path"});
  if (!kinds.deltas && !kinds.sky) out.push_back("light");
  return out;
}

RenderOptions Agreement::drawn(Dice& dice, const std::string& integrator) const {
  RenderOptions o = statistical(integrator, scene.hints.max_depth);
  o.heuristic = dice.any({Heuristic::power, Heuristic::power, Heuristic::balance});
  o.roulette_depth = dice.any({5, 5, 2, 20});
  o.learn.structure = dice.any({Structure::adaptive, Structure::adaptive, Structure::grid, Structure::probes});
  o.learn.rule = dice.any({Rule::expected, Rule::expected, Rule::returned});
  o.learn.guided = dice.any({Guided::both, Guided::both, Guided::camera, Guided::light});
  o.learn.train = dice.any({0u, 0u, 0u, 4u});
  o.learn.lights = choice == LightChoice::tree && dice.chance(0.8);
  o.learn_lights = (integrator == "path" || integrator == "bdpt") && choice == LightChoice::tree && dice.chance(0.3);
  if (integrator.ends_with("path") && !made.kinds.point_lights) o.next_event = dice.chance(0.8);
  return o;
}

std::string Agreement::told(const RenderOptions& o) const {
  return fmt::format(
      "{} (heuristic {}, roulette {}, structure {}, rule {}, guided {}, train {}, lights {} {} {}, next event {})",
      o.integrator, int(o.heuristic), o.roulette_depth, int(o.learn.structure), int(o.learn.rule), int(o.learn.guided),
      o.learn.train, light_choice_names[int(choice)], o.learn.lights, o.learn_lights, o.next_event);
}

// A difference that a quick look suspects has to be there in a longer one, of other numbers, too.
using Look = std::function<kit::Estimate(uint32_t effort, uint64_t seed)>;
void expect_agreement(const Look& look, const Look& right, const std::string& what) {
  const kit::Slack slack{.faint = 1e-3};  // what a filter's corners show, hardly a camera's sample
  if (kit::z_test(look(1, 1000), right(1, 1), 1e-2, 3, slack).ok) return;
  const kit::Estimate a = look(8, 1500), b = right(8, 500);
  const kit::ZTest z = kit::z_test(a, b, 1e-5, 3, slack);
  std::fprintf(stderr, "%s: mean %g for %g, %s\n", what.c_str(), mean(a), mean(b), z.message.c_str());
  EXPECT_TRUE(z.ok) << what;
}

TEST_P(Agreement, InEveryBlock) {
  SCOPED_TRACE(made.noted + '\n' + made.xml);
  Dice dice(~GetParam());
  std::map<uint32_t, kit::Estimate> known;
  const Look bdpt = [&](uint32_t effort, uint64_t seed) {
    kit::Estimate& e = known[effort];
    if (e.mean.empty())
      e = measure(scene, statistical("bdpt", scene.hints.max_depth),
                  {.batches = 12, .passes = 20 * effort, .seed = seed});
    return e;
  };
  for (const std::string& integrator : able(made.kinds)) {
    const RenderOptions o = drawn(dice, integrator);
    const uint32_t passes = integrator == "path" || integrator == "light" ? 60 : 20;
    const Look look = [&](uint32_t effort, uint64_t seed) {
      return measure(scene, o, {.batches = 12, .passes = passes * effort, .seed = seed});
    };
    expect_agreement(look, bdpt, told(o));
  }
}

// Whoever renders with two threads, and goes on from a checkpoint at each look, has the image of one thread that was
// let be.
TEST_P(Agreement, StopsAndThreadsDoNotMatter) {
  const Accel accel(scene);
  Dice dice(GetParam() + 1000000);
  const std::vector<std::string> names = tried_integrators();
  RenderOptions o = drawn(dice, names[size_t(dice.below(int(names.size())))]);
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

TEST_P(Agreement, FramesOfAnAnimation) {
  std::vector<Scene> frames;
  for (const char* shift : {"0", "0.1", "0.2"}) frames.push_back(at(shift));
  Dice dice(GetParam() + 2000000);
  RenderOptions o = drawn(dice, dice.any({"guided-bdpt", "guided-bdpt", "vpl"}));
  o.learn.train = 0;
  o.spp = 8;
  o.threads = 1;
  SequenceOptions sequence{.teach = 1, .begin = 10};
  sequence.coherence = {dice.chance(0.8), dice.chance(0.8)};
  SCOPED_TRACE(told(o) + ", " + made.noted + '\n' + made.xml);
  const Picture straight = last_frame(frames, o, sequence);
  RenderOptions threads = o;
  threads.threads = 2;
  const auto by_file = [](Carried& carried) {
    const File file("ajar-random-carried");
    save_carried(file.path, "key", carried);
    carried = load_carried(file.path, "key");
  };
  EXPECT_TRUE(same_bytes(straight.pixels, last_frame(frames, threads, sequence, by_file).pixels));

  const auto look = [&](uint32_t effort, uint64_t seed) {
    std::vector<std::vector<double>> runs;
    RenderOptions run = o;
    for (run.seed = seed; run.seed < seed + 12; ++run.seed) {
      run.spp = 20 * effort;
      const Picture p = last_frame(frames, run, sequence);
      runs.emplace_back(p.pixels.begin(), p.pixels.end());
    }
    return kit::estimate(straight.width, straight.height, std::move(runs));
  };
  const auto right = [&](uint32_t effort, uint64_t seed) {
    return measure(frames[2], statistical("bdpt", o.max_depth), {.batches = 12, .passes = 20 * effort, .seed = seed});
  };
  expect_agreement(look, right, told(o));
}

std::vector<uint64_t> numbers() {
  uint64_t from = 1, to = 4;
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
