#include "grammar.h"

namespace ajar::random {
namespace {

std::string bsdf(const std::string& type, Parts inside) { return element("bsdf", type, inside); }
std::string texture(const char* name, const std::string& type, Parts inside) {
  return element("texture", type, inside, fmt::format(R"( name="{}")", name));
}
std::string maybe(Dice& dice, double p, const std::string& part) { return dice.chance(p) ? part : ""; }

std::string repeated(Dice& dice) {
  const int x = 1 + dice.below(5), y = 1 + dice.below(5);
  return fmt::format(R"(<transform name="to_uv"><scale x="{}" y="{}"/></transform>)", x, y);
}

// A colour or a texture.
std::string albedo(Dice& dice, const char* name, double a = 0.1, double b = 0.85) {
  const double kind = dice.between(0, 1);
  if (kind < 0.7) return colour(dice, name, a, b);
  if (kind < 0.85)
    return texture(name, "checkerboard", {colour(dice, "color0", a, b), colour(dice, "color1", a, b), repeated(dice)});
  return texture(name, "bitmap", {text("filename", "albedo.png"), repeated(dice)});
}

std::string value(Dice& dice, const char* name, double a, double b) {
  if (dice.chance(0.8)) return number(name, dice.between(a, b));
  return texture(name, "checkerboard",
                 {number("color0", dice.between(a, b)), number("color1", dice.between(a, b)), repeated(dice)});
}

std::string distribution(Dice& dice) { return text("distribution", dice.any({"ggx", "beckmann"})); }

std::string roughness(Dice& dice, double a, double b) {
  if (dice.chance(0.6)) return joined({distribution(dice), value(dice, "alpha", a, b)});
  return joined({distribution(dice), value(dice, "alpha_u", a, b), value(dice, "alpha_v", a, b)});
}

// Rough glass that all but has the index of what is around it scatters into lobes that only light subpaths find.
std::string refraction(Dice& dice) {
  return joined(
      {number("int_ior", dice.between(1.3, 1.8)), number("ext_ior", dice.chance(0.7) ? 1 : dice.between(1, 1.15))});
}

std::string tint(Dice& dice, const char* name) { return dice.chance(0.3) ? colour(dice, name, 0.4, 1) : ""; }

std::string principled(Dice& dice, bool transmits) {
  std::string inside = joined({albedo(dice, "base_color"), value(dice, "roughness", 0.25, 0.8)});
  for (const char* name :
       {"anisotropic", "metallic", "spec_tint", "sheen", "sheen_tint", "clearcoat", "clearcoat_gloss", "flatness"})
    if (dice.chance(0.3)) inside += number(name, dice.between(0, 1));
  if (transmits) inside += value(dice, "spec_trans", 0.3, 1);
  return bsdf("principled", {inside, number("eta", dice.between(1.2, 1.8))});
}

std::string metal(Dice& dice) { return text("material", dice.any({"Au", "Al", "Cu", "none", "Cr"})); }

std::string relief(const std::string& type, Parts inside) {
  const bool bump = type == "bumpmap";
  return bsdf(type, {texture(bump ? "map" : "normalmap", "bitmap",
                             {text("filename", bump ? "bump.exr" : "normal.exr"), yes("raw")}),
                     joined(inside)});
}

std::string smooth(Dice& dice, bool deltas) {
  if (!deltas) return bsdf("diffuse", {albedo(dice, "reflectance")});
  const std::string type = dice.one({"plastic", "conductor"});
  if (type == "conductor") return bsdf(type, {metal(dice)});
  return bsdf(type, {albedo(dice, "diffuse_reflectance"), tint(dice, "specular_reflectance"),
                     maybe(dice, 0.5, yes("nonlinear"))});
}

std::string nested(Dice& dice, bool deltas, int depth) {
  const std::string type = dice.one({"blendbsdf", "mixturebsdf", "bumpmap", "normalmap"});
  if (type == "blendbsdf")
    return bsdf(type, {value(dice, "weight", 0.1, 0.9), opaque(dice, deltas, depth), opaque(dice, deltas, depth)});
  if (type == "mixturebsdf")
    return bsdf(type, {text("weights", "0.4, 0.5"), opaque(dice, deltas, depth), opaque(dice, deltas, depth)});
  if (type == "bumpmap") return relief(type, {number("scale", dice.between(0.05, 0.4)), opaque(dice, deltas, depth)});
  return relief(type, {opaque(dice, deltas, depth)});
}

std::string either_side(Dice& dice, bool deltas) {
  if (dice.chance(0.5)) return opaque(dice, deltas, 1);
  dice.note("twosided");
  return bsdf("twosided", {opaque(dice, deltas, 1), dice.chance(0.4) ? opaque(dice, deltas, 1) : ""});
}

std::string delta_through(Dice& dice, int depth) {
  const std::string type = dice.one({"dielectric", "thindielectric", "mask", "null"});
  if (type == "mask")
    return bsdf(type, {value(dice, "opacity", 0.1, 0.9),
                       dice.chance(0.6) || depth > 1 ? either_side(dice, true) : through(dice, true, depth + 1)});
  if (type == "null")
    return bsdf("blendbsdf", {value(dice, "weight", 0.1, 0.9), bsdf("null", {}), either_side(dice, true)});
  return bsdf(type, {refraction(dice), tint(dice, "specular_transmittance")});
}

}  // namespace

std::string opaque(Dice& dice, bool deltas, int depth) {
  const int kind = dice.below(depth < 2 ? 16 : 12);
  if (kind < 3) return bsdf("diffuse", {albedo(dice, "reflectance")});
  if (kind == 3) return smooth(dice, deltas);
  if (kind >= 12) return nested(dice, deltas, depth + 1);
  const std::string type = dice.one({"roughplastic", "roughconductor", "principled", "phong", "ward", "roughdiffuse"});
  if (type == "roughplastic")
    return bsdf(type, {albedo(dice, "diffuse_reflectance"), distribution(dice),
                       number("alpha", dice.between(0.08, 0.5)), maybe(dice, 0.5, yes("nonlinear"))});
  if (type == "roughconductor") return bsdf(type, {metal(dice), roughness(dice, 0.08, 0.6)});
  if (type == "principled") return principled(dice, false);
  if (type == "roughdiffuse") return bsdf(type, {albedo(dice, "reflectance"), number("alpha", dice.between(0.1, 0.9))});
  const std::string both =
      joined({albedo(dice, "diffuse_reflectance", 0.1, 0.5), colour(dice, "specular_reflectance", 0.1, 0.4)});
  if (type == "phong") return bsdf(type, {both, value(dice, "exponent", 3, 60)});
  return bsdf(type, {both, value(dice, "alpha_u", 0.1, 0.5), value(dice, "alpha_v", 0.1, 0.5),
                     text("variant", dice.any({"ward", "ward-duer", "balanced"}))});
}

std::string through(Dice& dice, bool deltas, int depth) {
  if (deltas && dice.chance(0.4)) return delta_through(dice, depth);
  const std::string type = depth > 1 ? dice.one({"roughdielectric", "difftrans", "principled glass"})
                                     : dice.one({"roughdielectric", "roughdielectric", "difftrans", "difftrans",
                                                 "principled glass", "blend through", "normalmap through"});
  if (type == "difftrans") return bsdf(type, {albedo(dice, "transmittance", 0.3, 0.9)});
  if (type == "principled glass") return principled(dice, true);
  if (type == "blend through")
    return bsdf("blendbsdf",
                {value(dice, "weight", 0.1, 0.9), through(dice, deltas, depth + 1), either_side(dice, deltas)});
  if (type == "normalmap through") return relief("normalmap", {through(dice, deltas, 2)});
  return bsdf(type, {refraction(dice), roughness(dice, 0.12, 0.6), tint(dice, "specular_transmittance")});
}

std::string material(Dice& dice, bool deltas) {
  if (dice.chance(0.5)) return through(dice, deltas);
  return dice.chance(0.6) ? either_side(dice, deltas) : opaque(dice, deltas);
}

}  // namespace ajar::random
