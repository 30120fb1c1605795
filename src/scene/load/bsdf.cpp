#include <fmt/format.h>

#include <algorithm>

#include "ajar/scene/bsdf/lobes.h"
#include "loader.h"
#include "nested.h"

namespace ajar {
namespace {

constexpr double index_of_polypropylene = 1.49;

// A number, or the name of a substance.
double index_of(Params& p, const char* name, double otherwise) {
  const Node* node = find(p, {name});
  if (node == nullptr) return otherwise;
  const std::string* value = attribute(*node, "value");
  std::optional<double> ior = value == nullptr ? std::nullopt : to_number(*value);
  if (!ior && node->tag == "string" && value != nullptr) ior = find_dielectric(*value);
  if (!ior && node->tag == "string") {
    unsupported(p.loader, *node, fmt::format("unknown substance; known are {}, or a number", dielectric_names()),
                fmt::format("{} in its place", otherwise));
    return otherwise;
  }
  if (!ior || !(*ior >= 1e-3 && *ior <= 1e3)) fail(p.loader, *node, "should be an index of refraction: 1.5, \"bk7\"");
  return *ior;
}

float relative_index(Params& p, double inside) {
  return float(index_of(p, "int_ior", inside) / index_of(p, "ext_ior", index_of_air));
}

void distribution(Params& p, Material& m) {
  const std::string word = choice(p, "distribution", "beckmann", {"beckmann", "ggx", "phong", "as"});
  m.distribution = word == "ggx" ? Microfacet::ggx : Microfacet::beckmann;
  if (word == "phong" || word == "as")
    note(p.loader, p.node, fmt::format("the {} distribution is rendered as beckmann of the same roughness", word));
}

// Surfaces are from 0 to 1; far beyond, the numbers of a lobe leave their range.
void limit_width(Params& p, const char* name, const Slot& s) {
  if (s.texture == none && max_component(s.value) > max_alpha)
    fail(p.loader, p.node, fmt::format("{} should be at most {}", name, max_alpha));
}

// Microfacets are never smoother than min_alpha.
Slot roughness(Params& p, const char* name, const Slot& otherwise) {
  Slot s = number_slot(p, name, otherwise);
  if (s.texture == none && !(luminance(s.value) >= min_alpha)) {
    note(p.loader, p.node, fmt::format("{} is rendered as {:g}: microfacets are never smoother", name, min_alpha));
    s.value = Rgb(min_alpha);
  }
  limit_width(p, name, s);
  return s;
}

void microfacets(Params& p, Material& m) {
  distribution(p, m);
  m.alpha_u = m.alpha_v = roughness(p, "alpha", 0.1f);
  m.alpha_u = roughness(p, "alpha_u", m.alpha_u);
  m.alpha_v = roughness(p, "alpha_v", m.alpha_v);
}

void diffuse(Params& p, Material& m) {
  m.reflectance = main_slot(p, {"reflectance", "diffuse_reflectance"}, 0.5f, Colour::reflectance);
}

void roughdiffuse(Params& p, Material& m) {
  diffuse(p, m);
  m.alpha_u = number_slot(p, "alpha", 0.2f);
  limit_width(p, "alpha", m.alpha_u);
  m.simple = boolean(p, "use_fast_approx", false);
}

void difftrans(Params& p, Material& m) { m.transmittance = main_slot(p, {"transmittance"}, 0.5f, Colour::reflectance); }

// eta or k, which do not vary over a surface.
Rgb index_of_metal(Params& p, const char* name, const Rgb& otherwise) {
  const Node* node = find(p, {name});
  if (node == nullptr || !is_texture(meant_by(p.loader, *node))) return colour(p, name, otherwise, Colour::ratio);
  unsupported(p.loader, *node,
              fmt::format("has to be one colour here, not a texture; write <rgb name=\"{}\" value=\"...\"/>", name),
              "its mean in its place");
  const Rgb found = mean(p.loader.scene, slot_of(p.loader, *node, Colour::ratio));
  return is_finite(found) ? found : otherwise;
}

void conductor(Params& p, Material& m) {
  m.specular = main_slot(p, {"specular_reflectance"}, 1.0f, Colour::reflectance);
  const char* usual = p.loader.document.old ? "Cu" : "none";
  const std::string name = text(p, "material", usual);
  const Metal* metal = find_metal(name);
  if (metal == nullptr) {
    unsupported(p.loader, p.node,
                fmt::format("unknown material \"{}\"; known are {}", name.substr(0, 80), metal_names()),
                fmt::format("{} in its place", usual));
    metal = find_metal(usual);
  }
  const float outside = float(index_of(p, "ext_eta", p.loader.document.old ? index_of_air : 1));
  m.eta = index_of_metal(p, "eta", metal->eta) / outside;
  m.k = index_of_metal(p, "k", metal->k) / outside;
}

void roughconductor(Params& p, Material& m) {
  conductor(p, m);
  microfacets(p, m);
}

void dielectric(Params& p, Material& m) {
  m.ior = relative_index(p, index_of_bk7);
  m.specular = slot(p, {"specular_reflectance"}, 1.0f, Colour::reflectance);
  m.transmittance = slot(p, {"specular_transmittance"}, 1.0f, Colour::reflectance);
}

void roughdielectric(Params& p, Material& m) {
  dielectric(p, m);
  microfacets(p, m);
}

void plastic(Params& p, Material& m) {
  m.ior = relative_index(p, index_of_polypropylene);
  m.reflectance = main_slot(p, {"diffuse_reflectance", "reflectance"}, 0.5f, Colour::reflectance);
  m.specular = slot(p, {"specular_reflectance"}, 1.0f, Colour::reflectance);
  if (boolean(p, "nonlinear", false)) m.inner = Inner::nonlinear;
}

void roughplastic(Params& p, Material& m) {
  plastic(p, m);
  distribution(p, m);
  m.alpha_u = m.alpha_v = roughness(p, "alpha", 0.1f);
  m.hides = !p.loader.document.old;
}

// Roughness and colours of roughplastic; what the boundary reflects back inside is lost.
void pplastic(Params& p, Material& m) {
  roughplastic(p, m);
  m.inner = Inner::lost;
  m.hides = false;
  m.alpha_u = roughness(p, "alpha_u", m.alpha_u);
  m.alpha_v = roughness(p, "alpha_v", m.alpha_v);
  note(p.loader, p.node, "light is not polarised in Ajar: its intensity alone is rendered");
}

// What unpolarised light makes of them: half of it passes, or all.
void polarizer(Params& p, Material& m) {
  m.ior = 1;
  m.transmittance = product(p, main_slot(p, {"transmittance"}, 1.0f, Colour::reflectance), 0.5f);
  for (const char* of_polarised : {"theta", "polarizing", "left_handed"}) find(p, {of_polarised});
  note(p.loader, p.node, "light is not polarised in Ajar: half of it passes, at every angle");
}
void retarder(Params& p, Material& m) {
  m.ior = 1;
  m.transmittance = main_slot(p, {"transmittance"}, 1.0f, Colour::reflectance);
  for (const char* of_polarised : {"theta", "delta"}) find(p, {of_polarised});
  note(p.loader, p.node, "light is not polarised in Ajar: all of it passes, at every angle");
}

// The diffuse and specular colours of phong and ward: of two that come to more than 1 both are scaled, each by itself
// may be above 1.
void two_colours(Params& p, Material& m) {
  const auto kind = [&](std::initializer_list<const char*> names) {
    const Node* node = find(p, names);
    return node && !is_texture(meant_by(p.loader, *node)) ? Colour::ratio : Colour::reflectance;
  };
  m.reflectance =
      main_slot(p, {"diffuse_reflectance", "reflectance"}, 0.5f, kind({"diffuse_reflectance", "reflectance"}));
  m.specular = slot(p, {"specular_reflectance"}, 0.2f, kind({"specular_reflectance"}));
  limit_sum(p, m);
}

void phong(Params& p, Material& m) {
  two_colours(p, m);
  m.exponent = number_slot(p, "exponent", 30.0f);
}

void ward(Params& p, Material& m) {
  two_colours(p, m);
  const auto width = [&](const char* name, const Slot& otherwise) {
    const Slot s = number_slot(p, name, otherwise);
    if (s.texture == none && !(luminance(s.value) > 0))
      fail(p.loader, p.node, fmt::format("{} should be greater than 0", name));
    limit_width(p, name, s);
    return s;
  };
  m.alpha_u = m.alpha_v = width("alpha", 0.1f);
  m.alpha_u = width("alpha_u", m.alpha_u);
  m.alpha_v = width("alpha_v", m.alpha_v);
  const std::string variant = choice(p, "variant", "balanced", {"ward", "ward-duer", "balanced"});
  if (variant == "ward") m.ward = WardKind::ward;
  if (variant == "ward-duer") m.ward = WardKind::duer;
}

void principled(Params& p, Material& m) {
  m.reflectance = main_slot(p, {"base_color"}, 0.5f, Colour::reflectance);
  const std::pair<const char*, Slot*> slots[] = {
      {"roughness", &m.roughness},   {"anisotropic", &m.anisotropic}, {"metallic", &m.metallic},
      {"spec_trans", &m.spec_trans}, {"spec_tint", &m.spec_tint},     {"sheen", &m.sheen},
      {"sheen_tint", &m.sheen_tint}, {"clearcoat", &m.clearcoat},     {"clearcoat_gloss", &m.clearcoat_gloss},
      {"flatness", &m.flatness}};
  for (const auto& [name, target] : slots) *target = number_slot(p, name, *target, Colour::reflectance);
  m.ior = float(number(p, "eta", 1.5));
  if (has(p, "specular")) {  // Burley 2012: reflectance at normal incidence is 0.08 times this
    const double specular = number(p, "specular", 0.5);
    if (!(specular >= 0 && specular <= 12)) fail(p.loader, p.node, "specular should be from 0 to 1; up to 12 is taken");
    const double least = has(p, "spec_trans") ? 1e-3 : 0;  // Mitsuba's in place of 0, where light may pass
    m.ior = float(2 / (1 - std::sqrt(0.08 * std::max(specular, least))) - 1);
    if (specular > 1)
      note(p.loader, p.node, fmt::format("specular is above 1: that of an index of refraction of {:.3g}", m.ior));
    if (has(p, "eta")) note(p.loader, p.node, "has eta and specular: specular is used");
  }
  if (!(m.ior >= 1e-3f && m.ior <= 1e3f)) fail(p.loader, p.node, "eta should be an index of refraction: 1.5");
}

void null(Params&, Material&) {}

struct MaterialReader {
  const char* type;
  MaterialKind kind;
  void (*read)(Params&, Material&);
};
constexpr MaterialReader material_readers[] = {{"diffuse", MaterialKind::diffuse, diffuse},
                                               {"twosided", MaterialKind::twosided, load_twosided},
                                               {"roughplastic", MaterialKind::roughplastic, roughplastic},
                                               {"plastic", MaterialKind::plastic, plastic},
                                               {"roughconductor", MaterialKind::roughconductor, roughconductor},
                                               {"conductor", MaterialKind::conductor, conductor},
                                               {"dielectric", MaterialKind::dielectric, dielectric},
                                               {"roughdielectric", MaterialKind::roughdielectric, roughdielectric},
                                               {"thindielectric", MaterialKind::thindielectric, dielectric},
                                               {"mask", MaterialKind::mask, load_mask},
                                               {"bumpmap", MaterialKind::bumpmap, load_bumpmap},
                                               {"normalmap", MaterialKind::normalmap, load_normalmap},
                                               {"blendbsdf", MaterialKind::blend, load_blend},
                                               {"mixturebsdf", MaterialKind::mixture, load_mixture},
                                               {"principled", MaterialKind::principled, principled},
                                               {"phong", MaterialKind::phong, phong},
                                               {"null", MaterialKind::null, null},
                                               {"roughdiffuse", MaterialKind::roughdiffuse, roughdiffuse},
                                               {"difftrans", MaterialKind::difftrans, difftrans},
                                               {"ward", MaterialKind::ward, ward},
                                               {"pplastic", MaterialKind::roughplastic, pplastic},
                                               {"polarizer", MaterialKind::thindielectric, polarizer},
                                               {"circular", MaterialKind::thindielectric, polarizer},
                                               {"retarder", MaterialKind::thindielectric, retarder}};

// With --lenient: what is nested in the unknown bsdf, or grey.
uint32_t stand_in(Loader& loader, const Node& node) {
  std::string known;
  for (const MaterialReader& e : material_readers) known += (known.empty() ? "" : ", ") + std::string(e.type);
  Params p(loader, node);
  const std::vector<const Node*> inner = nested(p, "bsdf");
  const char* hint = node.type == "mixture" ? ", mixturebsdf today" : "";
  unsupported(loader, node, fmt::format("{}{}; supported: {}", unknown(node), hint, known),
              inner.empty() ? "grey diffuse in its place" : "what is nested in it in its place");
  if (!inner.empty()) return load_bsdf(loader, *inner.front());
  return add_material(loader, node, {});
}

}  // namespace

void limit_sum(Params& p, Material& m) {
  const Scene& scene = p.loader.scene;
  const float sum = max_component(maximum(scene, m.reflectance) + maximum(scene, m.specular));
  if (sum <= 1) return;
  note(p.loader, p.node, "diffuse and specular reflectance add up to more than 1: both were scaled down");
  const float factor = (p.loader.document.old ? 0.99f : 1.0f) / sum;  // Mitsuba 0.6 leaves a little
  for (Slot* slot : {&m.reflectance, &m.specular})
    *slot = slot->texture == none ? Slot(slot->value * factor) : product(p, *slot, factor);
}

uint32_t add_material(Loader& loader, const Node& node, const Material& material) {
  int size = 1;
  for (const uint32_t nested : material.nested)
    if (nested != none) size += loader.material_sizes[nested];
  if (size > max_tree) fail(loader, node, fmt::format("is made of more than {} bsdfs; leave some out", max_tree));
  const uint32_t index = uint32_t(loader.scene.materials.size());
  loader.material_sizes.push_back(size);
  loader.scene.materials.push_back(material);
  const std::string problem = material_problem(loader.scene, index);
  if (problem.empty()) return index;
  unsupported(loader, node, problem, "the first of them in its place");
  loader.scene.materials.pop_back();
  loader.material_sizes.pop_back();
  return material.nested[0] == none ? add_material(loader, node, {}) : material.nested[0];
}

uint32_t load_bsdf(Loader& loader, const Node& node) {
  const auto found = loader.bsdfs.find(&node);
  if (found != loader.bsdfs.end()) return found->second;
  const Open open(loader, node);
  const std::string type = loader.document.old && node.type == "bump" ? "bumpmap" : node.type;  // as 0.4 calls it
  const auto reader = std::find_if(std::begin(material_readers), std::end(material_readers),
                                   [&](const MaterialReader& e) { return type == e.type; });
  uint32_t index;
  if (reader == std::end(material_readers)) {
    index = stand_in(loader, node);
  } else {
    Material m;
    m.kind = reader->kind;
    Params p(loader, node);
    reader->read(p, m);
    finish(p, {"specular_sampling_weight", "specular_sampling", "main_specular_sampling_rate",
               "clearcoat_sampling_rate", "diffuse_reflectance_sampling_rate", "specular_reflectance_sampling_rate",
               "specular_transmittance_sampling_rate", "diffuse_transmittance_sampling_rate", "sample_visible", "id"});
    index = add_material(loader, node, m);
  }
  loader.bsdfs.emplace(&node, index);
  return index;
}

}  // namespace ajar
