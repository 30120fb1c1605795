#include "parts.h"

namespace ajar {
namespace {

std::vector<Part> parts_by_name(Params& p) {
  std::vector<Part> parts;
  std::set<std::string, std::less<>> names;
  Part rest;
  for (const Node& child : p.node.children) {
    const Node& meant = follow(p.loader, child);
    if (meant.tag != "bsdf") continue;
    if (child.named.empty() && rest.bsdf != nullptr) fail(p.loader, child, "is the second bsdf without a name");
    if (child.named.empty()) {
      rest.bsdf = &meant;
      continue;
    }
    if (!names.insert(child.named).second) fail(p.loader, child, "has the name of another bsdf");
    parts.push_back({child.named, &meant, [name = child.named](std::string_view m) { return m == name; }});
  }
  rest.takes = [names](std::string_view m) { return !names.contains(m); };
  parts.push_back(std::move(rest));
  return parts;
}

}  // namespace

std::vector<Part> parts_of(Params& p) {
  const std::vector<const Node*> bsdfs = nested(p, "bsdf");
  if (bsdfs.size() > 1 && p.node.type == "obj") return parts_by_name(p);
  if (bsdfs.size() > 1) fail(p.loader, p.node, "has more than one bsdf");
  return {{"", bsdfs.empty() ? nullptr : bsdfs.front(), {}}};
}

uint32_t material_of(Params& p, const Part& part, bool emits) {
  if (part.bsdf != nullptr) return load_bsdf(p.loader, *part.bsdf);
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
