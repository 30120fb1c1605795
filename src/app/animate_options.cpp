#include "animate_options.h"

#include <fmt/format.h>

#include "ajar/core/error.h"
#include "options.h"

namespace ajar {
namespace {

// More than an image needs: cells of where things were are kept, and those of where they are must find room.
constexpr const char* usual_memory = "32M";

constexpr const char* coherences[] = {"on", "fields", "numbers", "off"};

void check_learning(const AnimateArguments& a, const std::string& integrator) {
  const std::pair<const char*, bool> asked[] = {{"--guide", a.guide != "both"},
                                                {"--field-memory", !a.field_memory.empty()},
                                                {"--teach", a.teach.has_value()},
                                                {"--forget", a.forget.has_value()},
                                                {"--even", a.even}};
  for (const auto& [option, given] : asked)
    if (given && !is_guided(integrator))
      throw Error(fmt::format("{}: the integrator {} learns no fields; take {}", option, integrator, what_learns));
  if (a.teach && a.coherent == "off")
    throw Error("--teach: with --coherent off frames learn as they render; leave it out");
  if (a.forget && a.coherent != "on" && a.coherent != "fields")
    throw Error(fmt::format("--forget: with --coherent {} no fields are carried on; leave it out", a.coherent));
}

}  // namespace

void add_options(CLI::App& command, AnimateArguments& arguments) {
  CLI::App* c = &command;
  AnimateArguments* a = &arguments;
  c->add_option("scene", a->scene, "Mitsuba XML scene")->required();
  c->add_option("-o,--out", a->out, "frames to write: DIR/frame_%04d.exr; a PNG and a JSON record go beside each")
      ->required();
  c->add_option("--frames", a->frames, "48 for all of 48 frames; 10-20/48 for some of them, counted from 0");
  c->add_option("-D", a->defines, "name=FROM..TO: a parameter that moves; :smooth eases it; name=value: one that stays")
      ->allow_extra_args(false);
  c->add_option("--keyframes", a->keyframes, "JSON file of parameters over frames");
  c->add_option("--at", a->at, "FROM..TO: time of the scene's <animation>s at the first and last frame (default: all)");
  c->add_option("--integrator", a->integrator, "as for ajar render (default: the scene's, else guided-bdpt)");
  c->add_option("--spp", a->spp, "samples per pixel of each frame")->check(whole(1, 1 << 30));
  c->add_option("--time", a->time, "wall time for each frame: 5s, 1m");
  c->add_option("--cpu-time", a->cpu_time, "CPU time of all threads for each frame");
  c->add_option("--seed", a->seed, "another seed, other noise (default 0)")->check(whole(0, ~uint64_t(0)));
  add_threads(*c, a->threads);
  c->add_option("--size", a->size, "WIDTHxHEIGHT instead of the scene's");
  c->add_option("--max-depth", a->max_depth, max_depth_help);
  c->add_option(
       "--coherent", a->coherent,
       "what frames have in common: on (learned fields and random numbers), fields, numbers or off (default on)")
      ->check(CLI::IsMember(listed(coherences)));
  c->add_option("--forget", a->forget, "share of the fields' evidence that lives on to the next frame (default 0.8)")
      ->check(number(0, 0.999));
  c->add_option("--teach", a->teach, "passes that teach the fields of a frame before it is rendered (default 1)")
      ->check(whole(1, 4096));
  c->add_option("--guide", a->guide, "which subpaths the learned fields guide: both, camera or light (default both)")
      ->check(CLI::IsMember(listed(guided_names)));
  c->add_option("--field-memory", a->field_memory, "memory that learned fields may take: 512K, 32M (default), 1G");
  c->add_flag("--even", a->even, "as for ajar render");
  c->add_flag("--limit-fireflies", a->limit_fireflies, "as for ajar render");
  c->add_option("--reference", a->reference, "frames to measure error and flicker against: DIR/ref_%04d.exr");
  c->add_option("--video", a->video, "film to make of the frames with ffmpeg: OUT.mp4, .mov, .mkv, .webm, .gif ...");
  c->add_option("--fps", a->fps, "of the film (default 24)")->check(number(1, 240));
  c->add_flag("--half", a->half, "16-bit floats in the EXR");
  c->add_flag("--lenient", a->lenient, "leave out what the loader does not know, with a note");
  c->add_flag("-q,--quiet", a->quiet, "no progress, no notes");
}

SequenceOptions sequence_options(const AnimateArguments& a) {
  SequenceOptions s;
  s.coherence = {a.coherent == "on" || a.coherent == "fields", a.coherent == "on" || a.coherent == "numbers"};
  s.teach = a.teach.value_or(s.teach), s.forget = a.forget.value_or(s.forget);
  return s;
}

RenderOptions render_options(const AnimateArguments& a, const Scene& scene) {
  RenderOptions o;
  if (!a.integrator.empty()) check_integrator(a.integrator);
  o.integrator = !a.integrator.empty()                   ? a.integrator
                 : is_integrator(scene.hints.integrator) ? scene.hints.integrator
                                                         : std::string("guided-bdpt");
  set_limits(a.time, a.cpu_time, a.spp, scene, o);
  o.seed = a.seed;
  o.threads = a.threads;
  set_max_depth(a.max_depth, scene, o);
  o.even = a.even;
  o.limit_fireflies = a.limit_fireflies;
  check_learning(a, o.integrator);
  check_guide(a.guide, o.integrator);
  o.learn.guided = Guided(index_of(guided_names, a.guide));
  o.learn.memory = parse_bytes("--field-memory", a.field_memory.empty() ? usual_memory : a.field_memory);
  return o;
}

}  // namespace ajar
