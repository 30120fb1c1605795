#include "scene/bsdf/cases.h"

#include <fmt/format.h>

#include <stdexcept>

#include "ajar/core/warp.h"

namespace ajar::test {

Material material(MaterialKind kind) {
  Material m;
  m.kind = kind;
  return m;
}

Material microfacet(MaterialKind kind, Microfacet distribution, float alpha_u, float alpha_v) {
  Material m = material(kind);
  m.distribution = distribution;
  m.alpha_u = alpha_u;
  m.alpha_v = alpha_v;
  m.eta = {0.2f, 0.9f, 1.5f};
  m.k = {3.9f, 2.4f, 1.9f};
  return m;
}

Material parent(MaterialKind kind, std::initializer_list<uint32_t> nested) {
  Material m = material(kind);
  std::copy(nested.begin(), nested.end(), m.nested.begin());
  return m;
}

Material with_normal(const Vec3& n, uint32_t nested) {
  Material m = parent(MaterialKind::normalmap, {nested});
  m.map = Slot(glm::normalize(n) * 0.5f + 0.5f);
  return m;
}

namespace {

Material coloured(MaterialKind kind, float alpha = 0.1f) {
  Material m = microfacet(kind, Microfacet::ggx, alpha, alpha);
  m.reflectance = Rgb(0.7f, 0.4f, 0.1f);
  m.specular = Rgb(0.9f, 0.8f, 0.95f);
  m.transmittance = Rgb(0.8f, 0.9f, 0.7f);
  return m;
}

void add_microfacets(std::vector<Case>& all, MaterialKind kind, const std::string& name, bool transmits) {
  for (const Microfacet d : {Microfacet::beckmann, Microfacet::ggx})
    for (const auto& [u, v] : {std::pair(0.01f, 0.01f), {0.1f, 0.1f}, {0.5f, 0.5f}, {0.05f, 0.4f}, {1.2f, 1.2f}}) {
      if (kind == MaterialKind::roughplastic && u != v) continue;
      Material m = coloured(kind);
      m.distribution = d;
      m.alpha_u = u;
      m.alpha_v = v;
      const std::string alpha =
          u == v ? fmt::format("{:.0f}", 100 * u) : fmt::format("{:.0f}x{:.0f}", 100 * u, 100 * v);
      const char* kind_name = d == Microfacet::ggx ? "ggx" : "beckmann";
      all.push_back({fmt::format("{}_{}_{}", name, kind_name, alpha), {m}, transmits, transmits});
    }
}

Material principled(float roughness, float metallic, float spec_trans, float anisotropic = 0) {
  Material m = coloured(MaterialKind::principled);
  m.ior = 1.5f;
  m.roughness = roughness;
  m.metallic = metallic;
  m.spec_trans = spec_trans;
  m.anisotropic = anisotropic;
  return m;
}

void add_principled(std::vector<Case>& all) {
  all.push_back({"principled_plain", {principled(0.5f, 0, 0)}});
  all.push_back({"principled_metal", {principled(0.3f, 0.9f, 0, 0.8f)}});
  all.push_back({"principled_glass", {principled(0.4f, 0, 1)}, true, true});
  Material air = principled(0.4f, 0, 1);
  air.ior = 0.67f;
  all.push_back({"principled_air", {air}, true, true});
  Material cloth = principled(0.6f, 0.1f, 0);
  cloth.sheen = 0.8f;
  cloth.sheen_tint = 0.5f;
  cloth.flatness = 0.7f;
  cloth.spec_tint = 0.6f;
  all.push_back({"principled_cloth", {cloth}});
  Material coat = principled(0.2f, 0, 0);
  coat.reflectance = 0.0f;
  coat.clearcoat = 10.0f;  // far beyond its range, so that this part dominates
  all.push_back({"principled_coat", {coat}});
  Material all_of_it = principled(0.35f, 0.3f, 0.6f, 0.5f);
  all_of_it.sheen = 0.4f;
  all_of_it.flatness = 0.3f;
  all_of_it.spec_tint = 0.5f;
  all_of_it.clearcoat = 1.0f;
  all_of_it.clearcoat_gloss = 0.3f;
  all.push_back({"principled_everything", {all_of_it}, true, true});
  all_of_it.ior = 0.75f;
  all.push_back({"principled_bubble", {all_of_it}, true, true});
}

void add_matte(std::vector<Case>& all) {
  for (const bool simple : {false, true})
    for (const float alpha : {0.3f, 1.0f}) {
      Material grooves = coloured(MaterialKind::roughdiffuse, alpha);
      grooves.simple = simple;
      all.push_back({fmt::format("roughdiffuse_{}_{:.0f}", simple ? "simple" : "full", 100 * alpha), {grooves}});
    }
  all.push_back({"difftrans", {coloured(MaterialKind::difftrans)}, true, true});
  for (const auto& [kind, name] :
       {std::pair(WardKind::ward, "ward"), {WardKind::duer, "duer"}, {WardKind::balanced, "balanced"}})
    for (const auto& [u, v] : {std::pair(0.02f, 0.02f), {0.1f, 0.4f}}) {
      Material ward = coloured(MaterialKind::ward);
      ward.ward = kind;
      ward.alpha_u = u;
      ward.alpha_v = v;
      ward.specular = 0.3f;
      ward.reflectance = Rgb(0.4f, 0.5f, 0.2f);
      all.push_back({fmt::format("ward_{}_{:.0f}x{:.0f}", name, 100 * u, 100 * v), {ward}});
    }
  Material lost = coloured(MaterialKind::roughplastic);
  lost.inner = Inner::lost;
  lost.alpha_u = 0.05f;
  lost.alpha_v = 0.4f;
  all.push_back({"roughplastic_lost", {lost}});
}

void add_nested(std::vector<Case>& all) {
  Material mask = parent(MaterialKind::mask, {1});
  mask.weight = 0.7f;
  all.push_back({"mask", {mask, coloured(MaterialKind::roughconductor, 0.3f)}, true, true});
  Material blend = parent(MaterialKind::blend, {1, 2});
  blend.weight = 0.3f;
  all.push_back(
      {"blend", {blend, coloured(MaterialKind::diffuse), coloured(MaterialKind::roughdielectric, 0.2f)}, true, true});
  all.push_back(
      {"blend_delta", {blend, coloured(MaterialKind::diffuse), coloured(MaterialKind::dielectric)}, true, true});
  Material mixture = parent(MaterialKind::mixture, {1, 2, 3});
  mixture.weights = {0.5f, 0.2f, 0.25f, 0};
  all.push_back(
      {"mixture",
       {mixture, coloured(MaterialKind::plastic), coloured(MaterialKind::phong), coloured(MaterialKind::conductor)}});
  blend.nested = {3, 2, none, none};
  all.push_back(
      {"mask_of_blend", {mask, blend, coloured(MaterialKind::roughplastic), material(MaterialKind::null)}, true, true});
  all.push_back(
      {"blend_bent",
       {parent(MaterialKind::blend, {1, 2}), with_normal({0.3f, 0.1f, 1}, 3), with_normal({-0.5f, 0.4f, 1}, 4),
        coloured(MaterialKind::diffuse), coloured(MaterialKind::roughdielectric, 0.3f)},
       true,
       true,
       true});
  all.push_back({"twosided", {parent(MaterialKind::twosided, {1}), coloured(MaterialKind::diffuse)}});
}

}  // namespace

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"diffuse", {coloured(MaterialKind::diffuse)}});
  all.push_back({"conductor", {coloured(MaterialKind::conductor)}});
  add_microfacets(all, MaterialKind::roughconductor, "roughconductor", false);
  all.push_back({"dielectric", {coloured(MaterialKind::dielectric)}, true, true});
  add_microfacets(all, MaterialKind::roughdielectric, "roughdielectric", true);
  Material bubble = coloured(MaterialKind::roughdielectric, 0.3f);
  bubble.ior = 0.7f;
  all.push_back({"roughdielectric_bubble", {bubble}, true, true});
  all.push_back({"thindielectric", {coloured(MaterialKind::thindielectric)}, true, true});
  all.push_back({"plastic", {coloured(MaterialKind::plastic)}});
  Material nonlinear = coloured(MaterialKind::plastic);
  nonlinear.inner = Inner::nonlinear;
  all.push_back({"plastic_nonlinear", {nonlinear}});
  add_microfacets(all, MaterialKind::roughplastic, "roughplastic", false);
  nonlinear.kind = MaterialKind::roughplastic;
  all.push_back({"roughplastic_nonlinear", {nonlinear}});
  for (const float n : {0.0f, 5.0f, 300.0f}) {
    Material phong = coloured(MaterialKind::phong);
    phong.specular = 0.3f;
    phong.reflectance = Rgb(0.4f, 0.5f, 0.2f);
    phong.exponent = n;
    all.push_back({fmt::format("phong_{}", int(n)), {phong}});
  }
  add_principled(all);
  add_matte(all);
  all.push_back({"null", {material(MaterialKind::null)}, true, true});
  add_nested(all);
  return all;
}

std::vector<Case> smooth_cases() {
  std::vector<Case> some = cases();
  std::erase_if(some, [](const Case& c) { return !resolved(c.materials).bsdf.has_smooth; });
  return some;
}
std::vector<Case> delta_cases() {
  std::vector<Case> some = cases();
  std::erase_if(some, [](const Case& c) { return !resolved(c.materials).bsdf.has_delta; });
  return some;
}

Case find_case(const std::string& name) {
  for (const Case& c : cases())
    if (c.name == name) return c;
  throw std::runtime_error("no case " + name);
}

Scene scene_of(const std::vector<Material>& materials) {
  Scene scene;
  scene.materials = materials;
  scene.shapes.emplace_back();
  prepare_materials(scene);
  return scene;
}

Resolved resolved(const std::vector<Material>& materials, const Vec3& wo) {
  Resolved r{scene_of(materials), {}, {}};
  r.surface.shape = 0;
  r.surface.dpdu = {1, 0, 0};
  r.surface.dpdv = {0, 1, 0};
  resolve(r.scene, r.surface, wo, r.surface.frame, r.bsdf);
  return r;
}

Vec3 random_direction(Sampler& sampler) { return to_sphere(sampler.next2()); }

}  // namespace ajar::test
