// ajar fields: statistics of a file of learned fields, and pictures of them.

#include "ajar/report/fields.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "ajar/core/error.h"
#include "ajar/core/files.h"
#include "apart.h"
#include "arguments.h"
#include "commands.h"
#include "options.h"
#include "say.h"

namespace ajar {
namespace {

struct FieldsArguments {
  std::string file, scene, out, size;
  std::vector<std::string> defines;
  std::optional<double> at;
  bool lenient = false;
};

constexpr const char* pictures[] = {"cells.png", "irradiance.png", "importance.png", "strata-q.png", "strata-w.png"};

void check_apart(const FieldsArguments& a, const Scene& scene) {
  std::vector<Named> written, read = files_of(scene);
  read.push_back({"the fields", a.file});
  for (const char* name : pictures) written.push_back({"-o, picture", (std::filesystem::path(a.out) / name).string()});
  require_apart(written, read);
}

void write_pictures(const FieldsArguments& a, const Scene& scene, const Fields& fields) {
  const Accel accel(scene);
  const auto write = [&](const char* name, const Picture& picture, const std::string& legend) {
    const std::string path = (std::filesystem::path(a.out) / name).string();
    write_png(path, picture);
    say(stdout, "{}: {}\n", path, legend);
  };
  const auto write_totals = [&](const char* name, Side side, const char* unit) {
    const FalseColour f = picture_totals(scene, accel, fields, side);
    write(name, f.picture, fmt::format("black {:.3g}, white {:.3g} {}, logarithmic", f.low, f.high, unit));
  };
  write(pictures[0], picture_cells(scene, accel, fields), "a colour for every cell");
  write_totals(pictures[1], Side::camera, "W/m^2");
  write_totals(pictures[2], Side::light, "pixels/m^2");
  write(pictures[3], picture_strata(scene, accel, fields, Side::camera), "where light comes from");
  write(pictures[4], picture_strata(scene, accel, fields, Side::light), "where importance comes from");
}

void show_fields(const FieldsArguments& a) {
  if (a.scene.empty() && !(a.out.empty() && a.size.empty() && a.defines.empty() && !a.at && !a.lenient))
    throw Error("-o, --size, -D, --at and --lenient are for pictures, and these need the scene: add --scene SCENE.xml");
  if (!a.scene.empty() && a.out.empty()) throw Error("--scene is for pictures: add -o FOLDER");
  if (!a.out.empty()) check_folder(a.out);
  if (a.scene.empty()) {
    say(stdout, "{}", describe(load_fields(a.file, {})));
    return;
  }
  Scene scene = load_scene(a.scene, load_options(a.defines, a.lenient, a.at));
  check_time(a.at, scene);
  check_apart(a, scene);
  say_notes(scene.notes);
  if (!a.size.empty()) set_size(scene.camera, a.size);
  const StoredFields stored = load_fields(a.file, scene_key(scene));
  say(stdout, "{}", describe(stored));
  make_folder(a.out);
  write_pictures(a, scene, stored.fields);
}

}  // namespace

void add_fields(CLI::App& app) {
  CLI::App* c = app.add_subcommand("fields", "Tell what a file of learned fields holds, with pictures on request");
  const auto a = std::make_shared<FieldsArguments>();
  c->add_option("file", a->file, "file that ajar render --save-fields wrote")->required();
  c->add_option("--scene", a->scene, "Mitsuba XML scene that they were learned in, for pictures");
  c->add_option("-o,--out", a->out, "folder for cells.png, irradiance.png, importance.png, strata-q.png, strata-w.png");
  c->add_option("--size", a->size, "WIDTHxHEIGHT of the pictures instead of the scene's");
  c->add_option("-D", a->defines, "name=value: a parameter of the scene")->allow_extra_args(false);
  add_time(*c, a->at);
  c->add_flag("--lenient", a->lenient, "leave out what the loader does not know, as ajar render does");
  c->callback([a] { show_fields(*a); });
}

}  // namespace ajar
