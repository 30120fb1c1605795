#include "parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace ajar {
namespace {

// Of several bsdfs Mitsuba 0.x takes the last, later versions none.
void note_several(Params& p, const Node& node, const char* what) {
  if (!p.loader.document.old) fail(p.loader, node, fmt::format("{}; keep one of them", what));
  note(p.loader, node, fmt::format("{}: the last one counts", what));
}

// The faces that no bsdf is for; all of them where there is no other part.
std::vector<MeshPart> with_rest(Params& p, std::vector<MeshPart> parts, const Node* bsdf) {
  const bool own = p.loader.document.old && p.node.type == "obj" && bsdf == nullptr;
  if (own && boolean(p, "load_materials", true)) add_library_parts(p, parts);
  if (parts.empty()) return {{"", bsdf, {}}};
  std::set<std::string> names;
  for (const MeshPart& part : parts) names.insert(part.name);
  parts.push_back({"", bsdf, std::move(names)});
  return parts;
}

std::vector<MeshPart> parts_by_name(Params& p) {
  std::vector<MeshPart> parts;
  std::set<std::string> names;
  const Node* rest = nullptr;
  for (const Node& child : p.node.children) {
    const Node& meant = follow(p.loader, child);
    if (meant.tag != "bsdf") continue;
    if (child.named.empty() && rest != nullptr) note_several(p, child, "is the second bsdf without a name");
    if (child.named.empty()) {
      rest = &meant;
      continue;
    }
    if (!names.insert(child.named).second) fail(p.loader, child, "has the name of another bsdf");
    parts.push_back({child.named, &meant, {}});
  }
  return with_rest(p, std::move(parts), rest);
}

// In version 0.x one bsdf is for the faces of its name too, where there are any.
bool goes_by_name(Params& p) {
  return p.loader.document.old && std::any_of(p.node.children.begin(), p.node.children.end(), [&](const Node& child) {
           return !child.named.empty() && follow(p.loader, child).tag == "bsdf" && has_material(p, child.named);
         });
}

}  // namespace

std::vector<MeshPart> parts_of(Params& p) {
  const std::vector<const Node*> bsdfs = nested(p, "bsdf");
  const bool several = bsdfs.size() > 1;
  if (p.node.type == "obj" && (several || (!bsdfs.empty() && goes_by_name(p)))) return parts_by_name(p);
  if (several) note_several(p, p.node, "has more than one bsdf");
  return with_rest(p, {}, bsdfs.empty() ? nullptr : bsdfs.back());
}

uint32_t material_of(Params& p, const MeshPart& part, bool emits) {
  if (part.bsdf != nullptr) return load_bsdf(p.loader, *part.bsdf);
  if (part.material != none) return part.material;
  if (p.loader.document.old && !emits && !nested(p, "medium").empty()) {  // the bounds of a medium are not seen
    Material m;
    m.kind = MaterialKind::null;
    return add_material(p.loader, p.node, m);
  }
  uint32_t& shared = emits ? p.loader.black : p.loader.grey;
  if (shared == none) {
    Material m;
    m.reflectance = Slot(emits ? 0.0f : 0.5f);
    shared = add_material(p.loader, p.node, m);
  }
  return shared;
}

}  // namespace ajar
