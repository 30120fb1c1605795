#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "ajar/core/error.h"
#include "ajar/core/srgb.h"
#include "mtl.h"
#include "obj.h"
#include "parts.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

// The file that another one means: beside that, or where the scene's files are; then the same without its folders,
// which may be another machine's. Empty if there is none.
std::string find_beside(const Params& p, const std::string& other, const std::string& name) {
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  std::error_code ignored;
  const auto beside = [&](const std::string& spelt) -> std::string {
    const fs::path path = fs::path(other).parent_path() / spelt;
    return !spelt.empty() && fs::is_regular_file(path, ignored) ? path.string() : std::string();
  };
  const std::string bare = fs::path(slashes).filename().string();
  for (std::string found : {beside(name), beside(slashes), find_file(p.loader.document, p.node, name), beside(bare),
                            find_file(p.loader.document, p.node, bare)})
    if (!found.empty()) return found;
  return {};
}

// A line after mtllib: one name with blanks, or several. Those that are missing are told.
std::vector<std::string> find_libraries(Params& p, const std::string& obj, const std::string& line) {
  if (const std::string whole = find_beside(p, obj, line); !whole.empty()) return {whole};
  std::vector<std::string> found;
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    const std::string path = find_beside(p, obj, word);
    if (path.empty())
      note(p.loader, p.node, fmt::format("{}: there is no mtllib \"{}\": its materials are grey", obj, word));
    else
      found.push_back(path);
  }
  return found;
}

struct Library {
  std::string path;
  std::shared_ptr<const MtlFile> file;
};

// Thousands of shapes may be groups of one obj: its libraries are read once.
Library open_library(Params& p, const std::string& path) {
  count_file(p.loader, p.node, path);
  std::shared_ptr<const MtlFile>& kept = p.loader.mtls[path];
  if (kept) return {path, kept};
  try {
    kept = std::make_shared<const MtlFile>(parse_mtl(read_bytes(path), path));
  } catch (const Error& error) {
    fail(p.loader, p.node, error.what());
  }
  if (!kept->unread.empty())
    note(p.loader, p.node, fmt::format("{}: not used: {}", path, fmt::join(kept->unread, ", ")));
  return {path, kept};
}

// What map_Kd and others name; otherwise where they name nothing, or what is not there. Heights (ratio) are raw.
Slot slot_of_map(Params& p, const std::string& library, const MtlMap& map, Colour kind, const Slot& otherwise) {
  if (map.file.empty()) return otherwise;
  const std::string path = find_beside(p, library, map.file);
  if (path.empty()) {
    note(p.loader, p.node, fmt::format("{}: there is no file \"{}\": left out", library, map.file));
    return otherwise;
  }
  count_file(p.loader, p.node, path);
  Texture t;
  t.flip_v = false;
  t.image = load_image_file(p.loader, p.node, path, kind == Colour::ratio, 0);
  t.image = limited_image(p.loader, p.node, t.image, kind);
  t.channel = map.channel;
  t.wrap_u = t.wrap_v = map.clamp ? Wrap::clamp : Wrap::repeat;
  // the file counts v from below, and its texture coordinates were turned when they were read
  const bool turned = boolean(p, "flip_tex_coords", true);
  t.to_uv[0][0] = map.scale.x, t.to_uv[1][1] = map.scale.y;
  t.to_uv[2] = Vec3(map.offset.x, turned ? 1 - map.scale.y - map.offset.y : map.offset.y, 1);
  Slot slot;
  slot.texture = add_texture(p.loader, p.node, std::move(t));
  return slot;
}

// Kd or Ks, which are encoded as sRGB.
Rgb decoded(Params& p, const MtlMaterial& m, const Rgb& c) {
  if (max_component(c) > 1)
    note(p.loader, p.node,
         fmt::format("usemtl {}: a reflectance above 1 would make light from nothing: it was set to 1", m.name));
  return glm::min(Rgb(decode_srgb(c.x), decode_srgb(c.y), decode_srgb(c.z)), Rgb(1));
}

bool is_glass(const MtlMaterial& m) { return m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9; }
bool is_mirror(const MtlMaterial& m) { return m.illum == 5 || m.illum == 8; }

// Glass and metal are those of Mitsuba's plugins, whatever Ni and Ks say.
void note_ignored(Params& p, const MtlMaterial& m) {
  if (is_glass(m) && m.ior > 0 && std::abs(m.ior - index_of_bk7) > 0.01)
    note(p.loader, p.node, fmt::format("usemtl {}: its Ni is not used: glass is bk7, as in Mitsuba", m.name));
  if (is_mirror(m) && m.has_specular)
    note(p.loader, p.node,
         fmt::format("usemtl {}: its Ks is not used: mirrors are of aluminium, as in Mitsuba", m.name));
}

// Without bumps and holes.
Material surface_of(Params& p, const std::string& library, const MtlMaterial& m) {
  Material out;
  note_ignored(p, m);
  if (is_glass(m)) {
    out.kind = MaterialKind::dielectric;
    out.ior = float(index_of_bk7 / index_of_air);
    return out;
  }
  if (is_mirror(m)) {
    const Metal* aluminium = find_metal("Al");
    out.kind = MaterialKind::conductor;
    out.eta = aluminium->eta / float(index_of_air), out.k = aluminium->k / float(index_of_air);
    return out;
  }
  out.reflectance = slot_of_map(p, library, m.map_diffuse, Colour::reflectance, decoded(p, m, m.diffuse));
  if (m.illum != 2 || !(m.exponent > 0)) return out;
  const Slot specular = slot_of_map(p, library, m.map_specular, Colour::reflectance, decoded(p, m, m.specular));
  if (specular.texture == none && is_black(specular.value)) return out;
  out.kind = MaterialKind::phong;
  out.specular = specular;
  out.exponent = Slot(m.exponent);
  limit_sum(p, out);
  return out;
}

// map_d, or d; glass is clear by itself.
Slot opacity_of(Params& p, const std::string& library, const MtlMaterial& m) {
  if (is_glass(m)) return 1.0f;
  const Slot opacity = slot_of_map(p, library, m.map_opacity, Colour::reflectance, m.opacity);
  if (opacity.texture == none && !(m.opacity > 0))
    note(p.loader, p.node, fmt::format("usemtl {} is not seen: its d is 0", m.name));
  return opacity;
}

uint32_t load_material(Params& p, const std::string& library, const MtlMaterial& m) {
  uint32_t id = add_material(p.loader, p.node, surface_of(p, library, m));
  Material around;
  around.map = slot_of_map(p, library, m.map_bump, Colour::ratio, 0.0f);
  if (around.map.texture != none) {
    around.kind = MaterialKind::bumpmap;
    around.map_scale = m.map_bump.height;
    around.nested[0] = id;
    id = add_material(p.loader, p.node, around);
  }
  Material mask;
  mask.kind = MaterialKind::mask;
  mask.weight = opacity_of(p, library, m);
  mask.nested[0] = id;
  const bool open = mask.weight.texture != none || max_component(mask.weight.value) < 1;
  return open ? add_material(p.loader, p.node, mask) : id;
}

// The file if it has this statement. Reading it again for its parts costs nothing.
const ObjFile* open_with(Params& p, const std::string& path, const char* statement) {
  if (p.loader.obj && p.loader.obj->name == path) return p.loader.obj.get();
  try {
    return read_bytes(path).find(statement) != std::string::npos ? &open_obj(p.loader, path) : nullptr;
  } catch (const Error& error) {
    fail(p.loader, p.node, error.what());
  }
}

// Which of its materials have faces in the shape, by index. A group of faces has one.
std::vector<uint32_t> shown_materials(Params& p, const ObjFile& obj) {
  std::vector<uint32_t> shown;
  const int group = obj_group(p);
  try {
    if (group >= 0) return {obj.faces[faces_of(obj, group).first].material};
  } catch (const Error& error) {
    fail(p.loader, p.node, error.what());
  }
  for (uint32_t i = 0; i < obj.materials.size(); ++i)
    if (!obj.runs[i].empty()) shown.push_back(i);
  return shown;
}

// The materials that faces have and no part has yet, in the order of the file.
std::vector<std::string> materials_left(Params& p, const ObjFile& obj, const std::vector<MeshPart>& parts) {
  std::set<std::string> names = {""};
  for (const MeshPart& part : parts) names.insert(part.name);
  std::vector<std::string> left;
  for (const uint32_t i : shown_materials(p, obj))
    if (!names.contains(obj.materials[i])) left.push_back(obj.materials[i]);
  return left;
}

}  // namespace

const ObjFile& open_obj(Loader& loader, const std::string& path) {
  if (loader.obj && loader.obj->name == path) return *loader.obj;
  auto obj = std::make_shared<ObjFile>(scan_obj(read_bytes(path), path));
  if (loader.document.old) weld(*obj);
  loader.obj = std::move(obj);
  return *loader.obj;
}

int obj_group(Params& p) {
  constexpr int most = 1 << 24;
  if (!p.loader.document.old) return -1;
  const bool collapse = boolean(p, "collapse", false);
  const int index = integer(p, "shape_index", -1, -1, collapse ? 0 : most);
  return collapse ? -1 : index;
}

bool has_material(Params& p, const std::string& name) {
  const ObjFile* obj = open_with(p, file(p, "filename"), "usemtl");
  return obj != nullptr && obj->by_name.contains(name);
}

void add_library_parts(Params& p, std::vector<MeshPart>& parts) {
  const std::string path = file(p, "filename");
  const ObjFile* obj = open_with(p, path, "mtllib");
  if (obj == nullptr) return;
  std::vector<Library> libraries;
  for (const std::string& line : obj->libraries)
    for (const std::string& found : find_libraries(p, path, line)) libraries.push_back(open_library(p, found));
  for (const std::string& name : materials_left(p, *obj, parts)) {
    // the last that has it counts
    const auto found = std::find_if(libraries.rbegin(), libraries.rend(),
                                    [&](const Library& l) { return l.file->by_name.contains(name); });
    if (found != libraries.rend())
      parts.push_back(
          {name, nullptr, {}, load_material(p, found->path, found->file->materials[found->file->by_name.at(name)])});
    else if (!libraries.empty())
      note(p.loader, p.node, fmt::format("{}: no mtllib has the material \"{}\": grey", path, name));
  }
}

}  // namespace ajar
