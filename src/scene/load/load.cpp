#include "ajar/scene/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "ajar/core/error.h"
#include "ajar/scene/build.h"
#include "loader.h"

namespace ajar {
namespace {

void collect_ids(Loader& loader, const Node& node) {
  for (const Node& child : node.children) {
    if (!child.id.empty() && child.tag != "ref") {
      const auto [known, added] = loader.ids.emplace(child.id, &child);
      if (!added)
        fail(loader, child,
             fmt::format("the id is taken already at {}:{}; rename one of them",
                         loader.document.files[known->second->file], known->second->line));
    }
    collect_ids(loader, child);
  }
}

// Both of the names of an <alias>, as Mitsuba has them: one that there is, and one that there is not.
void check_aliases(const Loader& loader) {
  const auto& aliases = loader.document.aliases;
  for (const auto& [as, node] : aliases) {
    const auto taken = loader.ids.find(as);
    if (taken != loader.ids.end())
      fail(loader, node,
           fmt::format("the id \"{}\" is taken already at {}:{}; rename one of them", shortened(as),
                       loader.document.files[taken->second->file], taken->second->line));
    if (!loader.ids.contains(node.id) && !aliases.contains(node.id))
      fail(loader, node,
           fmt::format("nothing in the scene has the id \"{}\"; correct it, or add what it names", shortened(node.id)));
  }
}

// How many shapes name each mesh file: only what is named twice is worth keeping.
void count_meshes(Loader& loader, const Node& node) {
  for (const Node& child : node.children) {
    if (child.tag != "shape") continue;
    const std::string* name = nullptr;
    std::string index = child.type == "serialized" ? "#0" : "";
    for (const Node& parameter : child.children) {
      if (parameter.name == "filename") name = attribute(parameter, "value");
      const std::string* value = attribute(parameter, "value");
      if (parameter.name == "shape_index" && value != nullptr) index = "#" + *value;
    }
    if (name != nullptr) ++loader.mesh_uses[find_file(loader.document, child, *name) + index];
    count_meshes(loader, child);
  }
}

bool is_definition(const Node& node) {
  static constexpr const char* tags[] = {"spectrum", "rgb", "srgb", "blackbody", "sampler", "film", "rfilter"};
  return std::find(std::begin(tags), std::end(tags), node.tag) != std::end(tags) ||
         (node.tag == "animation" && !node.id.empty());
}

// What the names of 0.3 and 0.4 became.
std::string later_name(const std::string& tag) {
  return tag == "camera" ? ", <sensor> today" : tag == "luminaire" ? ", <emitter> today" : "";
}

// The one that Mitsuba takes of several: the first, in 0.x the last. Null where there is none.
const Node* sensor_of(Loader& loader) {
  std::vector<const Node*> sensors;
  for (const Node& child : loader.document.root.children)
    if (child.tag == "sensor") sensors.push_back(&child);
  if (sensors.empty()) return nullptr;
  const Node* used = loader.document.old ? sensors.back() : sensors.front();
  if (sensors.size() > 1)
    note(loader, *used,
         fmt::format("the scene has several sensors: the {} one is used", loader.document.old ? "last" : "first"));
  return used;
}

// In its place, as Mitsuba has it: along z, from where all of the scene is within 45 degrees.
void add_sensor(Scene& scene, const std::string& name) {
  if (!add_camera(scene)) {
    const bool empty = scene.shapes.empty() && scene.instances.empty();
    throw Error(fmt::format("{}: the scene has no camera{}: add <sensor type=\"perspective\"> with a to_world{}", name,
                            empty ? " and no shape" : "", empty ? ", and <shape>s to see" : ""));
  }
  scene.notes.push_back(name +
                        ": the scene has no camera: all of it is seen, along +z; add <sensor type=\"perspective\">");
}

// Whether the file speaks of a light, even if it was left out.
bool names_emitter(const Node& node) {
  return std::any_of(node.children.begin(), node.children.end(), [](const Node& child) {
    return child.tag == "emitter" || child.tag == "luminaire" || names_emitter(child);
  });
}

// What Mitsuba 0.x lights a scene with that has no light.
constexpr const char* usual_light =
    "<scene version='0.6.0'><emitter type='sunsky'><transform name='toWorld'><rotate y='1' angle='-120'/></transform>"
    "<float name='scale' value='2'/><float name='sunRadiusScale' value='15'/></emitter></scene>";

void light_up(Loader& loader, const std::string& name) {
  if (!loader.document.old || names_emitter(loader.document.root)) {
    loader.scene.notes.push_back(name + ": the scene has no light: the image will be black");
    return;
  }
  load_emitter(loader, read_document(usual_light, "", name, {}).root.children.front(), none);
  loader.scene.notes.push_back(name + ": the scene has no light: sun and sky were added, as Mitsuba 0.x does");
}

void load_child(Loader& loader, const Node& node, bool& has_integrator) {
  if (node.tag == "bsdf") {
    load_bsdf(loader, node);
  } else if (node.tag == "shape") {
    load_shape(loader, node, none);
  } else if (node.tag == "emitter") {
    if (node.type != "area" || node.id.empty()) load_emitter(loader, node, none);
  } else if (node.tag == "sensor") {
    // one of them is read before all else
  } else if (node.tag == "integrator") {
    if (has_integrator) return note(loader, node, "the scene has several integrators: the first one is used");
    has_integrator = true;
    load_integrator(loader, node);
  } else if (node.tag == "medium" || node.tag == "phase" || node.tag == "volume") {
    note(loader, node,
         loader.lenient ? "participating media are not supported: left out"
                        : "participating media are not supported; a shape that names it is an error");
  } else if (node.tag == "texture") {
    check_texture(loader, node);  // read where it is named: only then is it known what its numbers stand for
  } else if (node.tag == "ref") {
    follow(loader, node);  // what it names is in the scene already
  } else if (node.tag == "null") {
    // nothing, of version 0.x
  } else if (is_definition(node)) {
    // read where it is named
  } else if (node.name.empty() || !node.children.empty()) {
    unsupported(
        loader, node,
        fmt::format("unknown element{}; supported: integrator, sensor, film, sampler, rfilter, bsdf, texture, "
                    "spectrum, rgb, srgb, blackbody, shape, emitter, animation with an id, ref, alias, default, "
                    "include, path",
                    later_name(node.tag)),
        "left out");
  }
}

// What stands in the document, once its elements are known by their ids.
void load_elements(Loader& loader, const LoadOptions& options, const std::string& name) {
  const Node& root = loader.document.root;
  const Node* sensor = sensor_of(loader);
  loader.time = options.time.value_or(sensor ? shutter_open(loader, *sensor) : 0);
  if (sensor) load_sensor(loader, *sensor);
  bool has_integrator = false;
  for (const Node& child : root.children) load_child(loader, child, has_integrator);
  if (loader.scene.shapes.empty() && loader.scene.instances.empty())
    loader.scene.notes.push_back(name + ": the scene has no shapes");
  if (loader.scene.lights.empty()) light_up(loader, name);
  if (!sensor) add_sensor(loader.scene, name);
  try {
    finish(loader.scene);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name, error.what()));
  }
}

Scene load(const std::string& text, const std::string& folder, const std::string& name, const LoadOptions& options,
           bool from_file) {
  const Document document = read_document(text, folder, name, options.defines);
  if (options.cache) check_texts(document, from_file, *options.cache);
  Loader loader{document, options.lenient, 0, options.cache};
  loader.scene.notes = document.notes;
  loader.scene.content = document.content;
  collect_ids(loader, document.root);
  check_aliases(loader);
  count_meshes(loader, document.root);
  try {
    load_elements(loader, options, name);
  } catch (const Error&) {
    check_unchanged(loader);  // one that is being written is not faulty
    throw;
  }
  check_unchanged(loader);
  loader.scene.files = document.files;
  for (const auto& [path, sum] : loader.sums) loader.scene.files.push_back(path);
  return std::move(loader.scene);
}

}  // namespace

Scene load_scene(const std::string& path, const LoadOptions& options) {
  return load(read_text(path), std::filesystem::path(path).parent_path().string(), path, options, true);
}

Scene load_scene_text(const std::string& text, const std::string& folder, const std::string& name,
                      const LoadOptions& options) {
  return load(text, folder, name, options, false);
}

}  // namespace ajar
