#include "render_options.h"

#include <fmt/format.h>

#include <charconv>

#include "ajar/core/error.h"
#include "ajar/render/plan.h"
#include "options.h"
#include "versus.h"

namespace ajar {
namespace {

double parse_noise(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  if (std::from_chars(text.data(), end, value).ptr != end || !(value > 0) || !std::isfinite(value))
    throw Error(fmt::format("--noise {}: not a target; write the relMSE to stop at, above 0, such as 0.01", text));
  return value;
}

float parse_merge_radius(float radius, const std::string& integrator) {
  if (!is_merging(integrator))
    throw Error(fmt::format("--merge-radius: {} merges nothing; take vcm, guided-vcm or photon", integrator));
  if (!(radius >= 0) || !std::isfinite(radius) || (radius == 0 && integrator == "photon"))
    throw Error(fmt::format("--merge-radius {}: write pixels, {}", radius,
                            integrator == "photon" ? "above 0" : "0 to merge nothing"));
  return radius;
}

LearnOptions learn_options(const RenderArguments& a, const std::string& integrator, bool may_learn) {
  const std::pair<const char*, bool> asked[] = {{"--save-fields", !a.save_fields.empty()},
                                                {"--load-fields", !a.load_fields.empty()},
                                                {"--guide", a.guide != "both"},
                                                {"--field-memory", !a.field_memory.empty()},
                                                {"--field-structure", !a.field_structure.empty()},
                                                {"--field-rule", !a.field_rule.empty()},
                                                {"--field-rate", !a.field_rate.empty()},
                                                {"--train", a.train > 0},
                                                {"--even", a.even}};
  const bool lights = a.light_choice == "learned";
  if (!may_learn)
    for (const auto& [option, given] : asked)
      if (given && !(lights && std::string_view(option) == "--field-memory"))
        throw Error(fmt::format("{}: the integrator {} learns no fields; take {}", option, integrator, what_learns));
  if (!a.load_fields.empty() && !a.resume.empty())
    throw Error("--load-fields: a checkpoint brings its own fields; leave out either this or --resume");
  if (!a.load_fields.empty() && !a.field_structure.empty())
    throw Error("--load-fields: stored fields bring their structure; leave out either this or --field-structure");
  if (a.train % 2) throw Error(fmt::format("--train {}: passes come in pairs; write an even number", a.train));
  check_guide(a.guide, integrator);
  LearnOptions o;
  o.lights = lights || a.light_choice.empty();
  o.guided = Guided(index_of(guided_names, a.guide));
  if (!a.field_structure.empty()) o.structure = Structure(index_of(structure_names, a.field_structure));
  if (!a.field_rule.empty()) o.rule = Rule(index_of(rule_names, a.field_rule));
  if (a.field_rate == "visits") o.forget = 1;
  o.train = uint32_t(a.train);
  if (!a.field_memory.empty()) o.memory = parse_bytes("--field-memory", a.field_memory);
  return o;
}

void check_next_event(const RenderOptions& o, const Scene& scene) {
  if (o.next_event) return;
  if (o.integrator != "path" && o.integrator != "guided-path")
    throw Error(fmt::format("--no-next-event: is for path and guided-path; {} finds light in more ways", o.integrator));
  for (const Light& light : scene.lights)
    if (has_no_extent(light.kind))
      throw Error("--no-next-event: the scene has lights without extent, which no ray can hit; leave it out");
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> out(1);
  for (const char c : list)
    if (c == ',')
      out.emplace_back();
    else
      out.back() += c;
  return out;
}

bool lists_parts(const RenderArguments& a) {
  return a.integrator.empty() && !a.plan.empty() && a.plan != "all" && a.plan != "auto";
}

// Nobody names an integrator: the plan is to choose one, or fields that are there to start from do.
bool names_none(const RenderArguments& a, const Scene& scene) {
  return a.integrator.empty() && (a.plan == "auto" || (a.plan.empty() && scene.hints.integrator.empty()));
}

// What the user names, else what the plan's parts make, else what the scene names. What is planned is chosen later; it
// may be what has the most options.
void choose_integrator(const RenderArguments& a, const Scene& scene, RenderOptions& o) {
  if (!a.integrator.empty()) {
    check_integrator(a.integrator);
    o.integrator = a.integrator;
  } else if (lists_parts(a)) {
    if (a.guide != "both") throw Error("--guide: the parts of --plan say what is guided; leave it out");
    apply_parts(split(a.plan), o);
  } else if (a.plan == "all" || names_none(a, scene)) {
    o.integrator = "guided-bdpt";
  } else if (is_integrator(scene.hints.integrator)) {
    o.integrator = scene.hints.integrator;
  }
}

}  // namespace

void add_options(CLI::App& command, RenderArguments& arguments) {
  CLI::App* c = &command;
  RenderArguments* a = &arguments;
  c->add_option("scene", a->scene, "Mitsuba XML scene")->required();
  c->add_option("-o,--out", a->out,
                "image to write: .exr, or .png for a tonemapped one (default: the scene's name, here)");
  c->add_flag("--png", a->png, "write a tonemapped PNG beside the EXR");
  c->add_option("--integrator", a->integrator,
                "path, bdpt, light, guided-path, guided-bdpt, vcm, guided-vcm, photon, vpl or plain-vpl (default: the "
                "scene's, else what the plan says)");
  c->add_option(
      "--plan", a->plan,
      "what to use: auto (guided-bdpt where there is time to learn, until path tracing turns out to be "
      "enough), all (to the end: path tracing never takes over from what "
      "guides), none (path tracing, or the integrator that is named, to the end), or a list of light-subpaths, "
      "camera-guiding, light-guiding (default: auto where no integrator is named)");
  c->add_option("--spp", a->spp,
                "samples per pixel; of --spp, --time, --cpu-time and --noise the first that is reached ends the render "
                "(default: the scene's spp, else 64)")
      ->check(whole(1, 1 << 30));
  c->add_option("--time", a->time, "wall time to render: 90s, 5m, 1h; with --resume, what was before counts");
  c->add_option("--cpu-time", a->cpu_time,
                "CPU time of all threads to render; as with --time, one whole pass is rendered however long it takes");
  c->add_option("--noise", a->noise, "relMSE to stop at, as estimated without a reference: 0.01");
  c->add_option("--seed", a->seed, "another seed, other noise (default 0)")->check(whole(0, ~uint64_t(0)));
  add_threads(*c, a->threads);
  c->add_option("--size", a->size, "WIDTHxHEIGHT instead of the scene's; the crop window is dropped");
  c->add_option("--max-depth", a->max_depth, max_depth_help);
  c->add_option("--roulette-depth", a->roulette_depth, "edges of a subpath before Russian roulette begins (default 5)")
      ->check(whole(1, 1 << 20));
  c->add_option("--heuristic", a->heuristic, "of multiple importance sampling: power (default) or balance")
      ->check(CLI::IsMember(listed(heuristic_names)));
  c->add_option("--sampler", a->sampler, "sobol (Owen-scrambled; default) or independent")
      ->check(CLI::IsMember(listed(sampler_names)));
  c->add_option("-D", a->defines, "name=value: a parameter of the scene")->allow_extra_args(false);
  add_time(*c, a->at);
  c->add_flag("--even", a->even,
              "as many camera samples in all pixels of a pass; guided integrators give noisy ones up to eight");
  c->add_flag(
      "--limit-fireflies", a->limit_fireflies,
      "darken what is far brighter than other passes saw around it (from the fourth pass on): fewer sparks, and a bias "
      "that time takes away");
  c->add_option("--aov", a->features, "more channels in the EXR: albedo,normal,position,variance")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"albedo", "normal", "position", "variance"}));
  c->add_option("--reference", a->reference, "image to measure the error against in the log");
  c->add_option("--log", a->log, "JSON lines at log-spaced times; with --resume they are added");
  c->add_option(
      "--techniques", a->techniques,
      "folder for an image of every strategy (s, t) with s + t <= 11, weighted and raw; those there are removed");
  c->add_option("--checkpoint", a->checkpoint, "file to save the state to, every minute and at the end");
  c->add_option("--resume", a->resume,
                "checkpoint to go on from, by its own integrator; its time and samples count in all limits");
  c->add_option("--guide", a->guide, "which subpaths the learned fields guide: both (default), camera or light")
      ->check(CLI::IsMember(listed(guided_names)));
  c->add_option("--field-memory", a->field_memory, "memory that all that is learned may take: 512K, 8M (default), 1G");
  c->add_option("--field-structure", a->field_structure, "of learned fields: adaptive (default), grid or probes")
      ->check(CLI::IsMember(listed(structure_names)));
  c->add_option("--field-rule", a->field_rule, "how they are learned: expected (default), max or return")
      ->check(CLI::IsMember(listed(rule_names)));
  c->add_option("--field-rate", a->field_rate,
                "of learning: recent (default: older evidence counts half), visits (1 / (1 + visits))")
      ->check(CLI::IsMember({"recent", "visits"}));
  c->add_option("--train", a->train,
                "passes that train the fields and are dropped, for half of a time limit at most; after them the fields "
                "are frozen")
      ->check(whole(2, 1 << 20));
  c->add_option(
       "--light-choice", a->light_choice,
       "of next-event estimation among lights: uniform, power, tree, or learned per cell by path, bdpt and guided "
       "integrators (default: learned for guided integrators, else tree)")
      ->check(CLI::IsMember(listed(light_choice_names)));
  c->add_option("--merge-radius", a->merge_radius,
                "of vcm, guided-vcm and photon in the first pass, in pixels (default 5); it shrinks; 0: no merging");
  c->add_option(
       "--final-gather", a->final_gather,
       "of photon: rays from the first surface that bring it indirect light, in place of the light vertices there")
      ->check(whole(1, 1024));
  c->add_flag("--no-next-event", a->no_next_event, "lights are found by hitting them alone: path and guided-path");
  c->add_option("--save-fields", a->save_fields, "file to save the learned fields to");
  c->add_option("--load-fields", a->load_fields, "fields to start from, saved from a render of the same scene");
  c->add_option(
      "--versus", a->versus,
      "path, bdpt, light or plain-vpl: gets the last tenth of the time, to tell how much error it would have left");
  c->add_flag("--half", a->half, "16-bit floats in the EXR");
  c->add_flag("--lenient", a->lenient, "leave out what the loader does not know, with a note");
  c->add_flag("-q,--quiet", a->quiet, "no progress, no notes");
}

namespace {

// Whether path tracing might ever take over from it.
bool leaves_out(const std::string& integrator) {
  RenderOptions o;
  o.integrator = integrator, o.leaves_out = true;
  return may_leave_out(o);
}

// Of --plan beside other options.
void check_plan(const RenderArguments& a) {
  const bool named = !a.integrator.empty();
  if (named && !a.plan.empty() && a.plan != "none" && a.plan != "all")
    throw Error("--plan: chooses the integrator; leave out either this or --integrator, or write --plan all");
  if (named && a.resume.empty() && a.plan == "all" && !leaves_out(a.integrator))  // a checkpoint names its own
    throw Error(fmt::format("--plan all: {} leaves nothing out; leave it out", a.integrator));
  if (a.plan == "auto" && !a.resume.empty())
    throw Error("--plan auto: a checkpoint goes on with the integrator that it began with; leave out --plan");
}

void check_light_choice(const RenderArguments& a, const std::string& integrator) {
  if (a.no_next_event && !a.light_choice.empty())
    throw Error(
        fmt::format("--light-choice {}: with --no-next-event no light is chosen; leave it out", a.light_choice));
  if (integrator == "light" && (a.light_choice == "tree" || a.light_choice == "learned"))
    throw Error(fmt::format(
        "--light-choice {}: light chooses its lights by power or uniform; leave it out, or take one", a.light_choice));
  if (a.light_choice == "learned" && !is_guided(integrator) && integrator != "path" && integrator != "bdpt")
    throw Error(fmt::format("--light-choice learned: {} learns no choice of lights; take path, bdpt or what guides",
                            integrator));
}

// How next-event estimation chooses among them.
void choose_lights(const RenderArguments& a, Scene& scene, bool planned, RenderOptions& o) {
  check_light_choice(a, o.integrator);
  o.learn_lights = a.light_choice == "learned" && (planned || !is_guided(o.integrator));
  if (a.light_choice == "uniform" || a.light_choice == "power")
    set_light_choice(scene, a.light_choice == "uniform" ? LightChoice::uniform : LightChoice::power);
}

// The other one has the same options.
void check_other(const RenderArguments& a, bool planned, const RenderOptions& options, const Scene& scene) {
  check_versus(a.versus, planned ? "what is planned" : options.integrator);
  RenderOptions other = options;
  other.integrator = a.versus;
  check_next_event(other, scene);
  check_light_choice(a, a.versus);
}

}  // namespace

bool plans(const RenderArguments& a, const Scene& scene) {
  check_plan(a);
  return names_none(a, scene) && a.resume.empty() && a.load_fields.empty();
}

std::string usual_light_choice(const std::string& integrator) {
  return is_guided(integrator) ? "learned" : integrator == "light" ? "power" : "tree";
}

std::string light_choice_of(const RenderArguments& a, const std::string& integrator) {
  return a.light_choice.empty() ? usual_light_choice(integrator) : a.light_choice;
}

RenderOptions render_options(const RenderArguments& a, Scene& scene, bool planned) {
  RenderOptions o;
  choose_integrator(a, scene, o);
  if (a.noise) o.noise = parse_noise(*a.noise);
  set_limits(a.time, a.cpu_time, a.spp, scene, o);
  o.seed = a.seed;
  o.threads = a.threads;
  set_max_depth(a.max_depth, scene, o);
  o.roulette_depth = a.roulette_depth;
  if (a.heuristic == "balance" && !weighs_strategies(o.integrator))
    throw Error(fmt::format("--heuristic balance: {} has one way to each path, and nothing to weigh; leave it out",
                            o.integrator));
  o.heuristic = Heuristic(index_of(heuristic_names, a.heuristic));
  o.sampler = SamplerKind(index_of(sampler_names, a.sampler));
  o.even = a.even;
  o.limit_fireflies = a.limit_fireflies;
  o.techniques = !a.techniques.empty();
  o.leaves_out = (a.plan.empty() || a.plan == "auto") && a.save_fields.empty();
  o.next_event = !a.no_next_event;
  if (a.merge_radius) o.merge_radius = parse_merge_radius(*a.merge_radius, o.integrator);
  o.final_gather = a.final_gather;
  if (o.final_gather > 0 && o.integrator != "photon")
    throw Error(fmt::format("--final-gather: {} has no photon map to gather from; take photon", o.integrator));
  check_next_event(o, scene);
  const Guided guided = o.learn.guided;
  o.learn = learn_options(a, o.integrator, planned || is_guided(o.integrator));
  if (lists_parts(a)) o.learn.guided = guided;
  choose_lights(a, scene, planned, o);
  if (!a.versus.empty()) check_other(a, planned, o, scene);
  if (o.techniques && !planned && !has_strategies(o.integrator))
    throw Error(
        fmt::format("--techniques: {} has no strategies to tell apart; take bdpt or guided-bdpt, say", o.integrator));
  return o;
}

}  // namespace ajar
