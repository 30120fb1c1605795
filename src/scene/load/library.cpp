#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "ajar/core/error.h"
#include "mtl.h"
#include "obj.h"
#include "parts.h"

namespace ajar {
namespace {

namespace fs = std::filesystem;

// The file that another one means: beside that, or where the scene's files are. Empty if there is none.
std::string find_beside(const Params& p, const std::string& other, const std::string& name) {
  std::string slashes = name;
  std::replace(slashes.begin(), slashes.end(), '\\', '/');
  std::error_code ignored;
  for (const std::string& spelt : {name, slashes}) {
    const fs::path path = fs::path(other).parent_path() / spelt;
    if (!name.empty() && fs::is_regular_file(path, ignored)) return path.string();
  }
  return find_file(p.loader.document, p.node, name);
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
  MtlFile file;
};

Library read_library(Params& p, const std::string& path) {
  count_file(p.loader, path);
  Library library{path, {}};
  try {
    library.file = parse_mtl(read_bytes(path), path);
  } catch (const Error& error) {
    fail(p.loader, p.node, error.what());
  }
  if (!library.file.unread.empty())
    note(p.loader, p.node, fmt::format("{}: not used: {}", path, fmt::join(library.file.unread, ", ")));
  return library;
}

// What map_Kd and others name; otherwise where they name nothing, or what is not there.
Slot slot_of_map(Params& p, const std::string& library, const MtlMap& map, bool raw, const Slot& otherwise) {
  if (map.file.empty()) return otherwise;
  const std::string path = find_beside(p, library, map.file);
  if (path.empty()) {
    note(p.loader, p.node, fmt::format("{}: there is no file \"{}\": left out", library, map.file));
    return otherwise;
  }
  count_file(p.loader, path);
  Texture t;
  t.flip_v = false;
  t.image = load_image_file(p.loader, p.node, path, raw, 0);
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

Rgb limited(Params& p, const MtlMaterial& m, const Rgb& c) {
  if (max_component(c) <= 1) return c;
  note(p.loader, p.node,
       fmt::format("usemtl {}: a reflectance above 1 would make light from nothing: it was set to 1", m.name));
  return glm::min(c, Rgb(1));
}

bool is_glass(const MtlMaterial& m) { return m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9; }
bool is_mirror(const MtlMaterial& m) { return m.illum == 5 || m.illum == 8; }

// Without bumps and holes.
Material surface_of(Params& p, const std::string& library, const MtlMaterial& m) {
  Material out;
  if (is_glass(m)) {
    out.kind = MaterialKind::dielectric;
    out.ior = m.ior > 1e-3f ? m.ior : 1.5f;
    return out;
  }
  const Slot specular = slot_of_map(p, library, m.map_specular, false, limited(p, m, m.specular));
  if (is_mirror(m)) {
    out.kind = MaterialKind::conductor;
    if (m.has_specular || specular.texture != none) out.specular = specular;
    return out;
  }
  out.reflectance = slot_of_map(p, library, m.map_diffuse, false, limited(p, m, m.diffuse));
  if (m.illum < 2 || !(m.exponent > 0) || (specular.texture == none && is_black(specular.value))) return out;
  out.kind = MaterialKind::phong;
  out.specular = specular;
  out.exponent = Slot(m.exponent);
  limit_sum(p, out);
  return out;
}

// d and map_d; glass is clear by itself.
Slot opacity_of(Params& p, const std::string& library, const MtlMaterial& m) {
  if (is_glass(m)) return 1.0f;
  if (!(m.opacity > 0)) note(p.loader, p.node, fmt::format("usemtl {} is not seen: its d is 0, or its Tr 1", m.name));
  return product(p, slot_of_map(p, library, m.map_opacity, true, 1.0f), m.opacity);
}

uint32_t load_material(Params& p, const std::string& library, const MtlMaterial& m) {
  uint32_t id = add_material(p.loader, p.node, surface_of(p, library, m));
  Material around;
  around.map = slot_of_map(p, library, m.map_bump, true, 0.0f);
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

// A look at all of the text is quick beside reading it.
bool names_libraries(const std::string& text) { return text.find("mtllib") != text.npos; }

const ObjFile* open_with_libraries(Params& p, const std::string& path) {
  if (p.loader.obj && p.loader.obj->name == path) return p.loader.obj.get();
  try {
    return names_libraries(read_bytes(path)) ? &open_obj(p.loader, path) : nullptr;
  } catch (const Error& error) {
    fail(p.loader, p.node, error.what());
  }
}

// The materials that faces have and no part has yet, in the order of the file.
std::vector<std::string> materials_left(const ObjFile& obj, const std::vector<Part>& parts) {
  std::vector<bool> has_faces(obj.materials.size());
  for (const ObjFile::Face& face : obj.faces) has_faces[face.material] = true;
  std::vector<std::string> left;
  for (size_t i = 1; i < obj.materials.size(); ++i)
    if (has_faces[i] &&
        std::none_of(parts.begin(), parts.end(), [&](const Part& part) { return part.name == obj.materials[i]; }))
      left.push_back(obj.materials[i]);
  return left;
}

}  // namespace

const ObjFile& open_obj(Loader& loader, const std::string& path) {
  if (!loader.obj || loader.obj->name != path)
    loader.obj = std::make_shared<const ObjFile>(scan_obj(read_bytes(path), path));
  return *loader.obj;
}

void add_library_parts(Params& p, std::vector<Part>& parts) {
  const std::string path = file(p, "filename");
  const ObjFile* obj = open_with_libraries(p, path);
  if (obj == nullptr) return;
  std::vector<Library> libraries;
  for (const std::string& line : obj->libraries)
    for (const std::string& found : find_libraries(p, path, line)) libraries.push_back(read_library(p, found));
  std::map<std::string, std::pair<const Library*, const MtlMaterial*>> known;
  for (const Library& library : libraries)
    for (const MtlMaterial& m : library.file.materials) known[m.name] = {&library, &m};
  for (const std::string& name : materials_left(*obj, parts)) {
    const auto found = known.find(name);
    if (found != known.end())
      parts.push_back({name, nullptr, [name](std::string_view m) { return m == name; },
                       load_material(p, found->second.first->path, *found->second.second)});
    else if (!libraries.empty())
      note(p.loader, p.node, fmt::format("{}: no mtllib has the material \"{}\": grey", path, name));
  }
}

}  // namespace ajar
