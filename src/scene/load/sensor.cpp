#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "loader.h"

namespace ajar {
namespace {

constexpr int max_film = 65536;
constexpr double film_diagonal = 43.266615305567875;  // mm, of 36 x 24

Filter read_filter(Loader& loader, const Node& node) {
  Params p(loader, node);
  static constexpr std::pair<const char*, FilterKind> kinds[] = {{"box", FilterKind::box},
                                                                 {"tent", FilterKind::tent},
                                                                 {"gaussian", FilterKind::gaussian},
                                                                 {"mitchell", FilterKind::mitchell},
                                                                 {"catmullrom", FilterKind::catmullrom},
                                                                 {"lanczos", FilterKind::lanczos}};
  const std::string name = node.type == "lanczossinc" ? "lanczos" : node.type;
  const auto found = std::find_if(std::begin(kinds), std::end(kinds), [&](const auto& k) { return name == k.first; });
  if (found == std::end(kinds)) {
    unsupported(loader, node, "unknown filter; supported: box, tent, gaussian, mitchell, catmullrom, lanczos",
                "gaussian in its place");
    return make_filter(FilterKind::gaussian, 0, 0.5f);
  }
  const auto sized = [&](const char* parameter, double otherwise) {
    const double x = positive(p, parameter, otherwise);
    if (x > 16 || x < 0.05) fail(loader, node, fmt::format("{} should be from 0.05 to 16 pixels", parameter));
    return float(x);
  };
  const FilterKind kind = found->second;
  const float radius = has(p, "radius") && kind != FilterKind::lanczos ? sized("radius", 1) : 0;
  Filter filter;
  if (kind == FilterKind::gaussian) {
    filter = make_filter(kind, radius, sized("stddev", 0.5));
  } else if (kind == FilterKind::mitchell) {
    const double b = number(p, "b", 1.0 / 3), c = number(p, "c", 1.0 / 3);
    if (!(std::abs(b) <= 4 && std::abs(c) <= 4)) fail(loader, node, "B and C should be from -4 to 4");
    filter = make_filter(kind, radius, float(b), float(c));
  } else if (kind == FilterKind::lanczos) {
    filter = make_filter(kind, 0, float(integer(p, "lobes", 3, 1, 16)));
  } else {
    filter = make_filter(kind, radius);
  }
  finish(p);
  return filter;
}

void read_film(Loader& loader, const Node& node, Camera& camera) {
  Params p(loader, node);
  static constexpr const char* known[] = {"hdrfilm", "ldrfilm", "mfilm", "tiledhdrfilm"};
  if (std::find(std::begin(known), std::end(known), node.type) == std::end(known))
    note(loader, node, fmt::format("unknown film; supported: {}: read as hdrfilm", fmt::join(known, ", ")));
  const bool is_one = node.type == "mfilm";  // as in Mitsuba: one pixel
  camera.width = integer(p, "width", is_one ? 1 : 768, 1, max_film);
  camera.height = integer(p, "height", is_one ? 1 : 576, 1, max_film);
  camera.crop_x = integer(p, "crop_offset_x", 0, 0, camera.width - 1);
  camera.crop_y = integer(p, "crop_offset_y", 0, 0, camera.height - 1);
  camera.crop_width = integer(p, "crop_width", camera.width - camera.crop_x, 1, camera.width - camera.crop_x);
  camera.crop_height = integer(p, "crop_height", camera.height - camera.crop_y, 1, camera.height - camera.crop_y);
  for (const Node* filter : nested(p, "rfilter")) loader.scene.filter = read_filter(loader, *filter);
  note_unused(p, {"id", "file_format", "pixel_format", "component_format", "banner", "attach_log", "high_quality_edges",
                  "gamma", "exposure", "tonemap_method", "key", "burn", "filename", "sample_border", "compensate",
                  "digits", "variable"});
}

ViewAxis view_axis(Params& p) {
  static constexpr std::pair<const char*, ViewAxis> axes[] = {{"x", ViewAxis::x},
                                                              {"y", ViewAxis::y},
                                                              {"smaller", ViewAxis::smaller},
                                                              {"larger", ViewAxis::larger},
                                                              {"diagonal", ViewAxis::diagonal}};
  const std::string word = choice(p, "fov_axis", "x", {"x", "y", "diagonal", "smaller", "larger"});
  return std::find_if(std::begin(axes), std::end(axes), [&](const auto& a) { return word == a.first; })->second;
}

// Tangent of half the field of view along camera.axis, from whatever the file gives.
double tan_half_view(Params& p, Camera& camera) {
  camera.axis = view_axis(p);
  if (has(p, "fov")) {
    const double fov = number(p, "fov", 0);
    if (!(fov >= 1e-3 && fov <= 179.9)) fail(p.loader, p.node, "fov should be from 0.001 to 179.9 degrees");
    return std::tan(glm::radians(fov) / 2);
  }
  std::string mm = text(p, "focal_length", "50mm");
  if (mm.ends_with("mm")) mm.resize(mm.size() - 2);
  const std::optional<double> focal = to_number(mm);
  if (!focal || !(*focal >= 0.1 && *focal <= 1e6)) fail(p.loader, p.node, "focal_length should be like \"50mm\"");
  camera.axis = ViewAxis::diagonal;
  return film_diagonal / (2 * *focal);
}

// Splits a camera's transform into scale along its axes and a rigid rest, which may be mirrored.
DVec3 take_scale(Params& p, DMat4& m) {
  const DVec3 scale{glm::length(DVec3(m[0])), glm::length(DVec3(m[1])), glm::length(DVec3(m[2]))};
  if (!(std::min({scale.x, scale.y, scale.z}) > 1e-30))
    fail(p.loader, p.node, "its to_world is singular; scale every axis by more than 0");
  const DVec3 z = DVec3(m[2]) / scale.z;
  DVec3 y = DVec3(m[1]) / scale.y, x = DVec3(m[0]) / scale.x;
  if (std::abs(glm::dot(x, y)) > 1e-3 || std::abs(glm::dot(y, z)) > 1e-3 || std::abs(glm::dot(z, x)) > 1e-3)
    fail(p.loader, p.node, "its to_world is sheared; axes should be at right angles");
  y = glm::normalize(y - z * glm::dot(y, z));  // the digits of a text file are not exactly at right angles
  x = glm::normalize(x - z * glm::dot(x, z) - y * glm::dot(x, y));
  m[0] = DMat4::col_type(x, 0);
  m[1] = DMat4::col_type(y, 0);
  m[2] = DMat4::col_type(z, 0);
  return scale;
}

void read_lens(Params& p, Camera& camera) {
  if (camera.kind != CameraKind::thinlens) return;
  camera.aperture = float(number(p, "aperture_radius", -1));
  if (!(camera.aperture >= 0 && camera.aperture <= farthest))
    fail(p.loader, p.node, fmt::format("needs an aperture_radius, 0 to {}", farthest));
  if (camera.aperture > 0 && std::isinf(camera.far_clip) && !has(p, "focus_distance"))
    fail(p.loader, p.node, "needs a focus_distance, as its far_clip is infinite");
  camera.focus = float(positive(p, "focus_distance", camera.aperture > 0 ? double(camera.far_clip) : 1));
  if (camera.aperture > 0) return;
  camera.kind = CameraKind::perspective;
  note(p.loader, p.node, "an aperture_radius of 0 is a pinhole: rendered as perspective");
}

// Mitsuba reads "inf" as C does.
double far_clip(Params& p) {
  const Node* node = find(p, {"far_clip"});
  const std::string* value = node != nullptr ? attribute(*node, "value") : nullptr;
  const std::string word = value != nullptr ? lower(*value) : "";
  return word == "inf" || word == "infinity" ? double(infinity) : number(p, "far_clip", 1e4);
}

void read_clip(Params& p, Camera& camera) {
  camera.near_clip = float(number(p, "near_clip", 1e-2));
  camera.far_clip = float(far_clip(p));
  const bool flat = camera.kind == CameraKind::orthographic;
  if (!(camera.near_clip >= (flat ? -farthest : 0) && camera.near_clip <= farthest &&
        camera.far_clip > camera.near_clip))
    fail(p.loader, p.node,
         fmt::format("near_clip and far_clip should be {} <= near < far, near at most {}",
                     flat ? fmt::format("{}", -farthest) : "0", farthest));
}

void read_view(Params& p, Camera& camera) {
  DMat4 m = to_world(p);
  const DVec3 scale = take_scale(p, m);
  const double aspect = double(camera.width) / camera.height;
  if (camera.kind == CameraKind::orthographic) {
    camera.to_world = Mat4(m);
    camera.to_camera = Mat4(glm::inverse(m));
    camera.plane = Vec2(float(scale.x), float(scale.y / aspect));
  } else {
    const double tan_x = tan_half_x(p, camera) * scale.x / scale.z;
    set_perspective(camera, float(glm::degrees(2 * std::atan(tan_x))), Mat4(m));
    camera.plane = Vec2(float(tan_x), float(tan_x / aspect * scale.y / scale.x));
  }
  require_near(p, DVec3(m[3]));
  if (!(std::min(camera.plane.x, camera.plane.y) > 1 / farthest && std::max(camera.plane.x, camera.plane.y) < farthest))
    fail(p.loader, p.node, "its to_world stretches the view beyond measure");
  const double x = number(p, "principal_point_offset_x", 0), y = number(p, "principal_point_offset_y", 0);
  if (!(std::abs(x) <= 100 && std::abs(y) <= 100)) fail(p.loader, p.node, "principal_point_offset should be small");
  camera.principal = Vec2(float(x), float(y));
  read_clip(p, camera);
  read_lens(p, camera);
}

void read_sampler(Loader& loader, const Node& node) {
  Params p(loader, node);
  const int count = hint(p, "sample_count", 0);
  if (count > 0) loader.scene.hints.spp = count;
  note_unused(p, {"id", "seed", "scramble", "dimension", "jitter"});
}

// 0 shows nothing at all: Ajar has no such images. What another renderer's integrator means by it does not matter.
void read_depth(Params& p, bool known) {
  const Node* node = find(p, {"max_depth"});
  const std::string* value = node ? attribute(*node, "value") : nullptr;
  if (node == nullptr) return;
  if (value == nullptr || to_number(*value) != 0.0)
    p.loader.scene.hints.max_depth = hint(p, "max_depth", -1, true);
  else if (known) {
    unsupported(p.loader, *node, "0 shows nothing; it should be 1 (lights alone) or more, or -1 for no limit",
                "no limit");
    p.loader.scene.hints.max_depth = -1;
  }
}

// Mitsuba 3's film for several sensors side by side.
void load_batch(Loader& loader, const Node& node) {
  Params p(loader, node);
  const std::vector<const Node*> sensors = nested(p, "sensor");
  unsupported(
      loader, node,
      "several sensors on one film are not supported: put one of those inside it in its place, with a film of its "
      "own, and render the others by themselves",
      "the first of them alone");
  if (sensors.empty()) fail(loader, node, "holds no sensor; put <sensor type=\"perspective\"> in its place");
  const Open open(loader, node);
  load_sensor(loader, *sensors.front());
}

}  // namespace

double tan_half_x(Params& p, Camera& camera) {
  const double along = tan_half_view(p, camera), aspect = double(camera.width) / camera.height;
  switch (camera.axis) {
    case ViewAxis::y:
      return along * aspect;
    case ViewAxis::smaller:
      return along * std::max(aspect, 1.0);
    case ViewAxis::larger:
      return along * std::min(aspect, 1.0);
    case ViewAxis::diagonal:
      return along * aspect / std::hypot(aspect, 1.0);
    default:
      return along;
  }
}

bool is_camera(const Node& node) {
  return node.type == "perspective" || node.type == "thinlens" || node.type == "orthographic";
}

std::string unknown_sensor(const Node& node) {
  return unknown(node) + "; supported: perspective, thinlens, orthographic";
}

double shutter_open(Loader& loader, const Node& node) {
  Params p(loader, node);
  return number(p, "shutter_open", 0);
}

void load_sensor(Loader& loader, const Node& node) {
  if (node.type == "batch") return load_batch(loader, node);
  Params p(loader, node);
  Camera& camera = loader.scene.camera;
  if (is_camera(node)) {
    camera.kind = node.type == "perspective" ? CameraKind::perspective
                  : node.type == "thinlens"  ? CameraKind::thinlens
                                             : CameraKind::orthographic;
  } else {
    unsupported(loader, node, unknown_sensor(node), "read as perspective");
  }
  camera.crop_width = camera.width;
  camera.crop_height = camera.height;
  loader.scene.filter = make_filter(FilterKind::gaussian, 0, 0.5f);
  const std::vector<const Node*> films = nested(p, "film");
  if (films.size() > 1) note(loader, node, "has more than one film: the first one counts");
  if (!films.empty()) read_film(loader, *films.front(), camera);
  for (const Node* sampler : nested(p, "sampler")) read_sampler(loader, *sampler);
  for (const Node* medium : nested(p, "medium"))
    unsupported(loader, *medium, "participating media are not supported", "left out");
  read_view(p, camera);
  finish(p, {"id", "shutter_open", "shutter_close", "srf", "focus_distance", "aperture_radius", "fov", "fov_axis"});
}

void load_integrator(Loader& loader, const Node& node) {
  struct Alias {
    const char *theirs, *ours;
  };
  static constexpr Alias names[] = {{"path", "path"},
                                    {"bdpt", "bdpt"},
                                    {"light", "light"},
                                    {"guided-path", "guided-path"},
                                    {"guided-bdpt", "guided-bdpt"},
                                    {"vcm", "vcm"},
                                    {"guided-vcm", "guided-vcm"},
                                    {"photon", "photon"},
                                    {"vpl", "vpl"},
                                    {"plain-vpl", "plain-vpl"},
                                    {"volpath", "path"},
                                    {"volpath-simple", "path"},
                                    {"volpathmis", "path"},
                                    {"ptracer", "light"},
                                    {"direct", "path"},
                                    {"direct-projective", "path"},
                                    {"direct-reparam", "path"},
                                    {"prb", "path"},
                                    {"prb-basic", "path"},
                                    {"prb-projective", "path"},
                                    {"prb-reparam", "path"},
                                    {"prbvolpath", "path"}};
  Hints& hints = loader.scene.hints;
  Params p(loader, node);
  std::string type = node.type;
  std::replace(type.begin(), type.end(), '_', '-');
  const auto name = std::find_if(std::begin(names), std::end(names), [&](const Alias& a) { return type == a.theirs; });
  const bool known = name != std::end(names);
  if (known && type.starts_with("prb") && type != "prbvolpath") hints.max_depth = 6;  // Mitsuba's default for them
  read_depth(p, known);
  if (known && type.starts_with("direct")) hints.max_depth = 2;  // light of what the camera sees, and no further
  const Lamps hidden = loader.document.old ? Lamps::dark : Lamps::gone;
  loader.scene.camera.lamps = boolean(p, "hide_emitters", false) ? hidden : Lamps::seen;
  const Open open(loader, node);
  if (const std::vector<const Node*> inner = nested(p, "integrator"); !inner.empty())
    return load_integrator(loader, *inner.front());  // aov, moment and others measure what another one renders
  if (!known)
    return note(loader, node, "Ajar has no integrator of this name: it chooses one as if the scene named none");
  hints.integrator = name->ours;
  note_unused(p, {"id", "rr_depth", "strict_normals", "samples_per_pass", "timeout", "block_size", "light_image",
                  "sample_direct", "emitter_samples", "bsdf_samples", "shading_samples", "max_null_collisions",
                  "granularity", "bruteforce"});
}

}  // namespace ajar
