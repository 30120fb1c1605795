// ajar animate: renders the frames of an animation, one after another, with what frames have in common kept.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "animate_frames.h"
#include "command_threads.h"
#include "commands.h"
#include "outputs.h"
#include "progress.h"
#include "say.h"
#include "stop.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

void write_film(const Animation& a) {
  const AnimateArguments& arguments = a.arguments;
  if (arguments.video.empty()) return;
  require_one_size(a);
  make_video(a.png, a.shooting.timeline.frames, arguments.fps.value_or(usual_fps), arguments.video);
  if (!arguments.quiet) say(stdout, "{}\n", arguments.video);
}

void write_figures(const Animation& a) {
  std::optional<FramePattern> reference;
  if (!a.arguments.reference.empty()) reference = parse_pattern("--reference", a.arguments.reference);
  const std::vector<FrameFigures> figures = measure(a.pattern, a.shooting.timeline, reference, a.options_key);
  const std::string stem = figures_stem(a);
  write_text(stem + ".json", sequence_json(figures));
  write_text(stem + ".csv", sequence_csv(figures));
  write_text(stem + ".svg", sequence_svg(figures, fmt::format("{}, {}", fs::path(a.arguments.scene).stem().string(),
                                                              a.options.integrator)));
  if (!a.arguments.quiet) say(stdout, "{}.json\n{}.csv\n{}.svg\n", stem, stem, stem);
}

// An error that only they have does not hide why the animation ended.
void write_figures_so_far(const Animation& a) {
  try {
    write_figures(a);
  } catch (const std::exception& error) {
    say(stderr, "ajar: warning: {}\n", error.what());
  }
}

void run_animate(const AnimateArguments& arguments) {
  Animation a = prepare(arguments);
  const FrameRange& r = a.shooting.timeline.frames;
  const int there = r.last - r.first + 1 - int(a.to_do.size());
  if (there > 0 && !arguments.quiet)
    say(stderr, "ajar: note: {} of {} frames are there already\n", there, r.last - r.first + 1);
  a.began = wall_seconds();
  catch_stop();
  try {
    if (!a.to_do.empty()) render_frames(a);
  } catch (...) {  // an interruption, or an error of a frame
    if (!arguments.quiet) clear_line();
    if (there + a.done > 0) write_figures_so_far(a);
    throw;
  }
  if (!arguments.quiet) clear_line();
  // An error that only the figures have, of a reference elsewhere in the folder, say, does not cost the film.
  write_each({[&] { write_figures(a); }, [&] { write_film(a); }});
}

}  // namespace

void add_animate(CLI::App& app) {
  auto a = std::make_shared<AnimateArguments>();
  CLI::App* c = app.add_subcommand("animate", "Render the frames of an animation (docs/animation.md)");
  add_options(*c, *a);
  c->callback([a] {
    const CommandThreads threads(a->threads);
    run_animate(*a);
  });
}

}  // namespace ajar
