#include "grammar.h"

namespace ajar::random {
namespace {

struct Place {
  double x, y, z;
};

enum class Room { open, closed, divided, floor };

struct Making {
  Dice dice;
  Kinds kinds;
  Room room = Room::open;
};

std::string vec(const char* name, Place p, const char* type = "vector") {
  return fmt::format(R"(<{} name="{}" x="{:.4g}" y="{:.4g}" z="{:.4g}"/>)", type, name, p.x, p.y, p.z);
}
std::string look(Place from, Place to) {
  return fmt::format(R"(<lookat origin="{:.4g}, {:.4g}, {:.4g}" target="{:.4g}, {:.4g}, {:.4g}" up="0, 1, 0.01"/>)",
                     from.x, from.y, from.z, to.x, to.y, to.z);
}
std::string turned(Dice& d) {
  const double x = d.between(-1, 1), y = d.between(-1, 1), z = d.between(0.1, 1);
  return fmt::format(R"(<rotate x="{:.2f}" y="{:.2f}" z="{:.2f}" angle="{:.1f}"/>)", x, y, z, d.between(0, 360));
}
std::string scaled(double x, double y, double z) {
  return fmt::format(R"(<scale x="{:.3f}" y="{:.3f}" z="{:.3f}"/>)", x, y, z);
}
std::string moved(Place p) { return fmt::format(R"(<translate x="{:.3f}" y="{:.3f}" z="{:.3f}"/>)", p.x, p.y, p.z); }
std::string to_world(Parts parts) { return R"(<transform name="to_world">)" + joined(parts) + "</transform>"; }

std::string quad(Place at, double width, double height, const char* axis, int angle, const std::string& inside) {
  return element(
      "shape", "rectangle",
      {to_world({scaled(width, height, 1), fmt::format(R"(<rotate {}="1" angle="{}"/>)", axis, angle), moved(at)}),
       inside});
}

std::string shape(Dice& d, Place at, double size, const std::string& inside, const std::string& type) {
  double x = size * d.between(0.7, 1.2), y = size * d.between(0.7, 1.2), z = size * d.between(0.7, 1.2);
  if (type == "sphere") x = y = z = size;
  if (type == "cylinder") x = y = 0.6 * size;
  if (d.chance(0.1)) x = -x, d.note("mirrored");
  const bool is_file = type.find('.') != std::string::npos;
  return element("shape", is_file ? type.substr(type.find('.') + 1) : type,
                 {is_file ? text("filename", type) : "", to_world({scaled(x, y, z), turned(d), moved(at)}),
                  d.chance(0.2) ? yes("flip_normals") : "", inside});
}
std::string any_shape(Dice& d) {
  return d.one({"sphere", "sphere", "cube", "rectangle", "disk", "cylinder", "globe.ply", "bent.ply", "sheet.obj"});
}

std::string radiance(Dice& d, double a, double b) {
  const double kind = d.between(0, 1);
  if (kind < 0.75) return colour(d, "radiance", a, b);
  d.note("textured");
  const std::string inside = kind < 0.88 ? joined({colour(d, "color0", 0, b / 4), colour(d, "color1", a, 1.5 * b)})
                                         : text("filename", "lamp.exr");
  return element("texture", kind < 0.88 ? "checkerboard" : "bitmap", {inside}, R"( name="radiance")");
}
std::string area(Dice& d, double a = 3, double b = 15) {
  return element("emitter", "area",
                 {radiance(d, a, b), d.chance(0.15) ? number("sampling_weight", d.between(0.3, 3)) : ""});
}
std::string lamp_material(Making& m) {
  const double kind = m.dice.between(0, 1);
  return kind < 0.5 ? "" : kind < 0.85 ? opaque(m.dice, m.kinds.deltas, 1) : through(m.dice, m.kinds.deltas, 1);
}

// Light that no path hits.
std::string point_light(Dice& d, Place at) {
  const std::string type = d.one({"point", "spot", "projector", "directional"});
  if (type == "point") return element("emitter", type, {vec("position", at, "point"), colour(d, "intensity", 0.5, 2)});
  if (type == "directional")
    return element("emitter", type,
                   {vec("direction", {d.between(-1, 1), -1, d.between(-1, 0.5)}), colour(d, "irradiance", 1, 4)});
  const std::string down = to_world({look(at, {d.between(-0.5, 0.5), -0.7, d.between(-0.5, 0.5)})});
  if (type == "projector")
    return element("emitter", type,
                   {down, number("fov", d.between(30, 90)),
                    element("texture", "bitmap", {text("filename", "albedo.png")}, R"( name="irradiance")")});
  const double cutoff = d.chance(0.8) ? d.between(20, 80) : d.between(95, 175);
  return element("emitter", type,
                 {down, number("cutoff_angle", cutoff), number("beam_width", cutoff * d.between(0.2, 0.99)),
                  colour(d, "intensity", 1, 6)});
}

std::string sky_light(Dice& d) {
  const std::string type = d.one({"constant", "envmap", "envmap", "sunsky", "sky"});
  if (type == "constant") return element("emitter", type, {colour(d, "radiance", 0.2, 1)});
  if (type == "envmap") return element("emitter", type, {text("filename", "sky.exr"), to_world({turned(d)})});
  return element("emitter", type,
                 {vec("sun_direction", {d.between(-1, 1), d.between(0.3, 1), d.between(-0.3, 1)}),
                  number("sun_radius_scale", d.any({3, 10, 20})), number("turbidity", d.between(2, 8)),
                  R"(<integer name="resolution" value="64"/>)", to_world({R"(<rotate x="1" angle="-90"/>)"})});
}

// A lamp within something that light comes through.
std::string lampshade(Making& m, Place at) {
  const double size = m.dice.between(0.25, 0.35);
  const std::string within = m.dice.one({"sphere", "cube", "disk", "rectangle", "cylinder"});
  const std::string shade = m.dice.one({"sphere", "cube", "globe.ply", "bent.ply"});
  return joined({shape(m.dice, at, size * m.dice.between(0.3, 0.55), area(m.dice, 10, 60), within),
                 shape(m.dice, at, 1.3 * size, through(m.dice, m.kinds.deltas), shade)});
}

std::string light(Making& m) {
  Dice& d = m.dice;
  Place at{d.between(-0.7, 0.7), d.between(0.3, 0.8), d.between(-0.7, 0.5)};
  if (m.room == Room::divided) at = {d.between(0.45, 0.75), d.between(-0.2, 0.6), d.between(-0.6, 0.2)};
  const bool outside = m.room == Room::open || m.room == Room::floor;
  if (m.kinds.point_lights && d.chance(0.5)) return point_light(d, at);
  if (outside && d.chance(0.4)) return m.kinds.sky = true, sky_light(d);
  const std::string kind = d.one({"ceiling", "shape", "shape", "lampshade"});
  if (kind == "lampshade") return lampshade(m, at);
  if (kind == "shape") return shape(d, at, d.between(0.1, 0.25), joined({area(d), lamp_material(m)}), any_shape(d));
  return quad({0.6 * at.x, 0.98, 0.6 * at.z}, d.between(0.15, 0.4), d.between(0.15, 0.4), "x", 90,
              joined({area(d), lamp_material(m)}));
}

std::string wall_material(Making& m) {
  const double kind = m.dice.between(0, 1);
  if (kind < 0.7) return element("bsdf", "diffuse", {colour(m.dice, "reflectance", 0.2, 0.8)});
  const std::string any = opaque(m.dice, m.kinds.deltas, 1);
  return kind < 0.85 ? element("bsdf", "twosided", {any}) : any;
}

std::string walls(Making& m) {
  std::string out = quad({0, -1, 0}, 1, 1, "x", -90, wall_material(m));
  if (m.room != Room::floor || m.dice.chance(0.5)) out += quad({0, 0, -1}, 1, 1, "y", 0, wall_material(m));
  if (m.room == Room::floor) return out;
  out += quad({-1, 0, 0}, 1, 1, "y", 90, wall_material(m));
  out += quad({1, 0, 0}, 1, 1, "y", -90, wall_material(m));
  if (m.room == Room::open) return out;
  out += quad({0, 1, 0}, 1, 1, "x", 90, wall_material(m));
  out += quad({0, 0, 1}, 1, 1, "y", 180, wall_material(m));
  if (m.room == Room::divided) {  // up to a gap at the camera's end
    const double gap = m.dice.between(0.05, 0.3);
    out += element("shape", "cube",
                   {to_world({scaled(0.03, 1, 1 - gap), moved({0.1, 0, -gap})}),
                    element("bsdf", "twosided", {opaque(m.dice, m.kinds.deltas, 2)})});
  }
  return out;
}

std::string object(Making& m) {
  Dice& d = m.dice;
  const double size = d.between(0.2, 0.4);
  const bool inside = m.room == Room::closed || m.room == Room::divided;
  Place at{d.between(-0.6, 0.6), d.between(-0.9 + size, 0), d.between(-0.6, inside ? 0.3 : 0.6)};
  if (m.room == Room::divided && std::abs(at.x - 0.1) < size + 0.1) at.x = -0.45;
  return shape(d, at, size, material(d, m.kinds.deltas), any_shape(d));
}

// One that $shift moves.
std::string mover(Making& m) {
  const Place at{m.dice.between(-0.6, 0.4), m.dice.between(-0.7, 0.5), m.dice.between(-0.6, 0.2)};
  return element("shape", "cube",
                 {to_world({scaled(0.15, 0.3, 0.1), turned(m.dice), moved(at), R"(<translate x="$shift"/>)"}),
                  material(m.dice, m.kinds.deltas)});
}

std::string instances(Making& m) {
  Dice& d = m.dice;
  d.note("instances");
  std::string out = element("shape", "shapegroup",
                            {shape(d, {0, 0.1, 0}, 0.4, material(d, m.kinds.deltas), any_shape(d)),
                             shape(d, {0.2, -0.4, 0.1}, 0.3, material(d, m.kinds.deltas), any_shape(d))},
                            R"( id="group")");
  for (int i = 0; i < 2; ++i) {
    const double x = d.any({-1, 1}) * d.between(0.4, 0.8), y = d.between(0.4, 0.8), z = d.between(0.4, 0.8);
    const Place at{d.between(-0.6, 0.6), d.between(-0.6, 0), d.between(-0.6, 0.3)};
    out += element("shape", "instance", {to_world({turned(d), scaled(x, y, z), moved(at)}), R"(<ref id="group"/>)"});
  }
  return out;
}

std::string film(Dice& d) {
  const int width = d.any({16, 16, 12, 18}), height = 12;
  std::string size =
      fmt::format(R"(<integer name="width" value="{}"/><integer name="height" value="{}"/>)", width, height);
  if (d.chance(0.2)) {
    d.note("crop");
    size = fmt::format(
        R"(<integer name="width" value="{}"/><integer name="height" value="{}"/><integer name="crop_offset_x" value="5"/><integer name="crop_offset_y" value="7"/><integer name="crop_width" value="{}"/><integer name="crop_height" value="{}"/>)",
        width + 9, height + 11, width, height);
  }
  const std::string filter = d.one({"box", "box", "tent", "gaussian", "gaussian", "mitchell", "catmullrom", "lanczos"});
  return element("film", "hdrfilm", {size, element("rfilter", filter, {})});
}

std::string sensor(Making& m) {
  Dice& d = m.dice;
  const bool inside = m.room == Room::closed || m.room == Room::divided;
  Place from{d.between(-0.6, 0.6), d.between(-0.2, 1), 3.2};
  if (inside) from = {m.room == Room::divided ? -0.6 : d.between(-0.7, 0.7), d.between(-0.2, 0.5), 0.93};
  const Place to{d.between(-0.2, 0.2) - (m.room == Room::divided ? 0.4 : 0), d.between(-0.5, -0.1), -0.2};
  const std::string type = d.one({"perspective", "perspective", "thinlens", "orthographic"});
  std::string extra, scale;
  if (type == "orthographic") {
    const double half = d.between(0.6, 1.2);
    scale = scaled(half, half, 1);
  } else {
    extra = number("fov", inside ? d.between(60, 95) : d.between(25, 45));
  }
  if (type == "thinlens")
    extra += joined({number("aperture_radius", d.between(0.02, inside ? 0.2 : 0.3)),
                     number("focus_distance", inside ? d.between(0.5, 1.5) : d.between(2, 4))});
  return element("sensor", type, {extra, to_world({scale, look(from, to)}), film(d)});
}

}  // namespace

RandomScene random_scene(uint64_t seed) {
  Making m{.dice = Dice(seed)};
  Dice& d = m.dice;
  const int family = d.below(4);  // half of them hold what all integrators see
  m.kinds = {.point_lights = family > 1, .deltas = family != 2};
  m.room = d.any({Room::open, Room::open, Room::closed, Room::closed, Room::divided, Room::floor});
  std::string xml = R"(<default name="shift" value="0"/>)";
  xml += fmt::format("<integrator type=\"path\"><integer name=\"max_depth\" value=\"{}\"/></integrator>\n",
                     d.any({2, 3, 4, 5, 8, -1, -1}));
  xml += joined({sensor(m), walls(m)});
  for (int i = d.any({1, 1, 1, 2, 2, 3}); i > 0; --i) xml += light(m);
  for (int i = d.any({1, 2, 2, 3}); i > 0; --i) xml += object(m);
  if (d.chance(0.15)) xml += instances(m);
  xml += mover(m);
  return {"<scene version=\"3.0.0\">\n" + xml + "</scene>\n", d.noted(), m.kinds};
}

}  // namespace ajar::random
