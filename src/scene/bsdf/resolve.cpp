#include "ajar/scene/bsdf.h"
#include "ajar/scene/bsdf/through.h"
#include "ajar/scene/scene.h"
#include "visit.h"

namespace ajar {
namespace {

struct Resolver {
  const Scene& scene;
  const Surface& surface;
  Frame& frame;
  Bsdf& out;
  bool back;               // the viewer is behind ng
  bool turned = false;     // frame.n was turned to the viewer; until the end s and t stay, as in a mirror
  bool split = false;      // inside a sum whose branches have normals of their own
  bool two_faced = false;  // another material is behind
};

Rgb look(const Resolver& r, const Slot& slot) {
  return slot.texture == none ? slot.value : eval(r.scene, slot, r.surface);
}
float look_scalar(const Resolver& r, const Slot& slot) {
  return slot.texture != none ? eval_scalar(r.scene, slot, r.surface) : scalar_of(slot.value);
}
// Weights of luminance do not add up to 1 in the last bit; a mask that is 1 must not let 1e-7 pass.
float look_unit(const Resolver& r, const Slot& slot) {
  const float x = look_scalar(r, slot);
  return x > 1 - 1e-6f ? 1 : std::max(x, 0.0f);
}

// Takes n (any length) as the new normal, on the side of ng that the material faces.
void bend(Resolver& r, Vec3 n) {
  const float l2 = length2(n);
  if (!(l2 > 0) || !std::isfinite(l2)) return;
  n *= 1 / std::sqrt(l2);
  if (glm::dot(n, r.surface.ng) * (r.turned ? -1.0f : 1.0f) < 0) n = -n;
  r.frame = make_frame(n, r.frame.s);
  if (r.turned) r.frame.t = -r.frame.t;
}

// Displacement of the surface along its shading normal by the height h (Blinn 1978): tangents get h_u n and h_v n.
void bend_by_height(Resolver& r, const Material& m) {
  const Vec2 slope = eval_gradient(r.scene, m.map, r.surface) * m.map_scale;
  const Vec3 n = r.frame.n, &dpdu = r.surface.dpdu, &dpdv = r.surface.dpdv;
  const Vec3 u = dpdu + n * (slope.x - glm::dot(n, dpdu)), v = dpdv + n * (slope.y - glm::dot(n, dpdv));
  const Vec3 bent = glm::cross(u, v);
  bend(r, facing(bent, n));
}

void bend_by_map(Resolver& r, const Material& m) {
  const Vec3 c = 2.0f * eval(r.scene, m.map, r.surface) - 1.0f;
  bend(r, r.frame.to_world(c));
}

Facets facets(const Resolver& r, const Material& m) {
  const auto look = [&](const Slot& alpha) { return std::clamp(look_scalar(r, alpha), min_alpha, max_alpha); };
  return {look(m.alpha_u), look(m.alpha_v), m.distribution};
}

// Diffuse light that enters, bounces inside under the boundary and leaves: internal reflectance is 1 - leaving / eta^2.
// Where nothing is lost as much leaves as enters: a boundary lets the same pass both ways but for the basic solid
// angle.
Rgb under_boundary(const Material& m, const Rgb& rho, float leaving) {
  if (m.inner == Inner::lost) return rho;
  if (m.inner == Inner::linear) return rho / leaving;
  return rho / (m.ior * m.ior * (Rgb(1) - rho) + rho * leaving);
}
float specular_share(const Rgb& specular, const Rgb& diffuse) {
  const float s = max_component(specular), d = max_component(diffuse);
  return s + d > 0 ? s / (s + d) : 0.5f;
}

void set_plastic(const Resolver& r, const Material& m, Lobe& lobe) {
  const Rgb rho = look(r, m.reflectance), specular = look(r, m.specular);
  lobe.kind = LobeKind::plastic;
  lobe.plastic = {under_boundary(m, rho, m.entering), specular, m.ior, specular_share(specular, rho), m.entering};
}

void set_roughplastic(const Resolver& r, const Material& m, Lobe& lobe) {
  const Rgb rho = look(r, m.reflectance), specular = look(r, m.specular);
  Facets f = facets(r, m);
  if (m.inner != Inner::lost) f.alpha_v = f.alpha_u;
  const TableRow row = table_row_of(m, f.alpha_u);
  lobe.kind = LobeKind::roughplastic;
  lobe.roughplastic = {row.at, row.between, Rgb(0), specular, m.ior, specular_share(specular, rho), f};
  lobe.roughplastic.base = under_boundary(m, rho, entry(lobe.roughplastic, table_leaving));
}

void set_principled(const Resolver& r, const Material& m, Lobe& lobe) {
  lobe.kind = LobeKind::principled;
  lobe.principled = {look(r, m.reflectance),
                     look_unit(r, m.roughness),
                     std::sqrt(1 - 0.9f * look_unit(r, m.anisotropic)),
                     look_unit(r, m.metallic),
                     look_unit(r, m.spec_trans),
                     std::abs(m.ior - 1) < min_ior_step ? 1 + min_ior_step : m.ior,
                     look_unit(r, m.spec_tint),
                     look_scalar(r, m.sheen),
                     look_unit(r, m.sheen_tint),
                     look_unit(r, m.flatness),
                     look_scalar(r, m.clearcoat),
                     0.1f + (0.001f - 0.1f) * look_unit(r, m.clearcoat_gloss)};
}

// Writes the lobe of an elementary material; false where it absorbs everything.
bool set_lobe(const Resolver& r, const Material& m, Lobe& lobe) {
  switch (m.kind) {
    case MaterialKind::conductor:
      lobe.kind = LobeKind::conductor;
      lobe.conductor = {look(r, m.specular), m.eta, m.k};
      return true;
    case MaterialKind::roughconductor:
      lobe.kind = LobeKind::roughconductor;
      lobe.roughconductor = {look(r, m.specular), m.eta, m.k, facets(r, m)};
      return true;
    case MaterialKind::roughdielectric:
      if (std::abs(m.ior - 1) >= min_ior_step) {
        lobe.kind = LobeKind::roughdielectric;
        lobe.roughdielectric = {look(r, m.specular), look(r, m.transmittance), m.ior, facets(r, m)};
        return true;
      }
      [[fallthrough]];
    case MaterialKind::dielectric:
      lobe.kind = LobeKind::dielectric;
      lobe.dielectric = {look(r, m.specular), look(r, m.transmittance), m.ior};
      return true;
    case MaterialKind::thindielectric:
      lobe.kind = LobeKind::thindielectric;
      lobe.thindielectric = {look(r, m.specular), look(r, m.transmittance), m.ior};
      return true;
    case MaterialKind::plastic:
      set_plastic(r, m, lobe);
      return true;
    case MaterialKind::roughplastic:
      set_roughplastic(r, m, lobe);
      return true;
    case MaterialKind::phong: {
      const Rgb diffuse = look(r, m.reflectance), specular = look(r, m.specular);
      lobe.kind = LobeKind::phong;
      lobe.phong = {diffuse, specular, std::max(look_scalar(r, m.exponent), 0.0f), specular_share(specular, diffuse)};
      return true;
    }
    case MaterialKind::principled:
      set_principled(r, m, lobe);
      return true;
    case MaterialKind::roughdiffuse: {
      // Mitsuba's alpha is the RMS slope in the plane, sqrt(2) times that along one direction.
      const float variance = 0.5f * sqr(look_scalar(r, m.alpha_u));
      lobe.kind = LobeKind::roughdiffuse;
      lobe.roughdiffuse = {look(r, m.reflectance), variance, m.simple};
      return !is_black(lobe.roughdiffuse.reflectance);
    }
    case MaterialKind::difftrans:
      lobe.kind = LobeKind::difftrans;
      lobe.difftrans = {look(r, m.transmittance)};
      return !is_black(lobe.difftrans.transmittance);
    case MaterialKind::ward: {
      const Rgb diffuse = look(r, m.reflectance), specular = look(r, m.specular);
      lobe.kind = LobeKind::ward;
      lobe.ward = {diffuse, specular, facets(r, m), specular_share(specular, diffuse), m.ward};
      lobe.ward.facets.kind = Microfacet::beckmann;
      return true;
    }
    default:
      lobe.kind = LobeKind::diffuse;
      lobe.diffuse = {look(r, m.reflectance)};
      return !is_black(lobe.diffuse.reflectance);
  }
}

bool is_delta(LobeKind k) {
  return k == LobeKind::conductor || k == LobeKind::dielectric || k == LobeKind::thindielectric ||
         k == LobeKind::plastic;
}
bool is_smooth(LobeKind k) { return !is_delta(k) || k == LobeKind::plastic; }
// What else than one kind of event: their samples read u_lobe.
bool is_mixed(LobeKind k) {
  return k != LobeKind::diffuse && k != LobeKind::conductor && k != LobeKind::roughconductor &&
         k != LobeKind::roughdiffuse && k != LobeKind::difftrans;
}
// Value and densities, deltas aside, for directions on two sides.
bool transmits(const Lobe& lobe) { return turns_through(lobe) && is_smooth(lobe.kind); }

void add(Resolver& r, uint32_t id, float weight);

void add_leaf(Resolver& r, const Material& m, float weight) {
  Bsdf& out = r.out;
  if (out.count == max_lobes) return;
  // A black lobe is left out, unless it is a part of a sum and may not be black from behind, see choose.
  if (!set_lobe(r, m, out.lobes[out.count]) && !(r.two_faced && weight < 1)) return;
  const LobeKind kind = out.lobes[out.count].kind;
  out.has_delta |= is_delta(kind);
  out.has_smooth |= is_smooth(kind);
  out.chooses |= is_mixed(kind);
  out.opaque &= !transmits(out.lobes[out.count]);
  if (r.split) out.normals[out.count] = r.frame.n;
  out.weights[out.count++] = weight;
}

// Follows one branch of a sum that splits; the others start from the same frame.
void add_branch(Resolver& r, uint32_t id, float weight) {
  const Frame frame = r.frame;
  const bool turned = r.turned;
  r.split = true;
  add(r, id, weight);
  r.frame = frame;
  r.turned = turned;
}

// Follows one nested material; branches recur.
void add(Resolver& r, uint32_t id, float weight) {
  while (weight > 0) {
    const Material& m = r.scene.materials[id];
    id = m.nested[0];
    switch (m.kind) {
      case MaterialKind::twosided:
        r.two_faced |= m.nested[1] != none;
        if (r.back && m.nested[1] != none) id = m.nested[1];
        if (r.back && !r.turned) r.frame.n = -r.frame.n, r.turned = true;
        break;
      case MaterialKind::mask: {
        const float opacity = look_unit(r, m.weight);
        r.out.opacity -= weight * (1 - opacity);
        weight *= opacity;
        break;
      }
      case MaterialKind::blend: {
        const float second = look_unit(r, m.weight);
        if (m.splits) {
          add_branch(r, m.nested[0], weight * (1 - second));
          return add_branch(r, m.nested[1], weight * second);
        }
        add(r, m.nested[0], weight * (1 - second));
        weight *= second;
        id = m.nested[1];
        break;
      }
      case MaterialKind::mixture:
        for (int i = 0; i < 4; ++i)
          if (m.nested[i] != none) (m.splits ? add_branch : add)(r, m.nested[i], weight * m.weights[i]);
        return;
      case MaterialKind::bumpmap:
        bend_by_height(r, m);
        break;
      case MaterialKind::normalmap:
        bend_by_map(r, m);
        break;
      case MaterialKind::null:
        r.out.opacity -= weight;
        return;
      default:
        add_leaf(r, m, weight);
        return;
    }
  }
}

// Probabilities in proportion to the albedo at a fixed angle: independent of direction, so that both densities share
// them. With another material behind, what turns light through has its weight, which is the same from both sides.
void choose(Bsdf& out, bool two_faced) {
  const Vec3 tilted{0.6f, 0, 0.8f};
  const auto is_fixed = [&](int i) { return two_faced && turns_through(out.lobes[i]); };
  float fixed = 0, sum = 0;
  for (int i = 0; i < out.count; ++i) {
    const Rgb a = visit(out.lobes[i], [&](const auto& lobe) { return albedo(lobe, tilted); });
    out.choice[i] = out.weights[i] * (is_fixed(i) ? 1 : std::max(max_component(a), 1e-3f));
    (is_fixed(i) ? fixed : sum) += out.choice[i];
  }
  const float all = sum > 0 ? 1 : out.opacity / fixed;  // nothing else
  for (int i = 0; i < out.count; ++i) out.choice[i] *= is_fixed(i) ? all : std::max(out.opacity - fixed, 0.0f) / sum;
  out.chooses = true;
  // Not by the albedo of the rest, which may be another material behind: the passage is the same both ways.
  out.pass = 1 - out.opacity;
  out.has_delta |= out.pass > 0;
}

// Normals of lobes become local; a lobe that was turned by itself is in front where the rest is behind.
void settle_normals(const Frame& frame, Bsdf& out) {
  out.bent = true;
  for (int i = 0; i < out.count; ++i) {
    out.normals[i] = frame.to_local(out.normals[i]);
    out.opaque &= out.normals[i].z > 0;
  }
}

// What a cut-out lets pass was no surface to the ray: all of what it stops is for the lobes.
void close_holes(Bsdf& out) {
  float sum = 0;
  for (int i = 0; i < out.count; ++i) sum += out.weights[i];
  const float stopped = std::max(out.opacity, sum);  // sum may be less: mixtures absorb, black lobes are left out
  for (int i = 0; i < out.count; ++i) out.weights[i] /= stopped;
  out.opacity = 1;
}

}  // namespace

void resolve(const Scene& scene, const Surface& surface, const Vec3& wo, Frame& frame, Bsdf& out) {
  out.count = 0;
  out.has_smooth = out.has_delta = out.chooses = false;
  out.opaque = true;
  out.bent = false;
  out.opacity = 1;
  out.pass = 0;
  const Shape& shape = scene.shapes[surface.shape];
  Resolver r{scene, surface, frame, out, glm::dot(wo, surface.ng) < 0};
  add(r, shape.material, 1);
  out.two_faced = r.two_faced;
  if (r.turned) frame.t = -frame.t;
  if (r.split) settle_normals(frame, out);
  out.choice[0] = 1;
  out.opacity = std::max(out.opacity, 0.0f);
  if (shape.mask != none && out.opacity < 1) close_holes(out);
  if (out.count != 1 || out.opacity < 1) choose(out, r.two_faced);
}

}  // namespace ajar
