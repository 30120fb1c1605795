#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "loader.h"

namespace ajar {
namespace {

DMat4 matrix_of(const Loader& loader, const Node& node) {
  const std::string* value = attribute(node, "value");
  const auto list = value == nullptr ? std::nullopt : to_numbers(*value);
  if (!list || (list->size() != 16 && list->size() != 9))
    fail(loader, node,
         fmt::format("needs value=\"...\" of 16 (or 9) numbers, row by row{}", about_suffix(value ? *value : "")));
  const int n = list->size() == 16 ? 4 : 3;
  DMat4 m(1);
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) m[column][row] = (*list)[size_t(row * n + column)];
  return m;
}

DVec3 point_attribute(const Loader& loader, const Node& node, const char* name) {
  const std::string* value = attribute(node, name);
  if (value == nullptr) fail(loader, node, fmt::format("needs {}=\"x, y, z\"", name));
  const auto list = to_numbers(*value);
  if (!list || list->size() != 3)
    fail(loader, node,
         fmt::format("{}=\"{}\" should be three numbers{}", name, value->substr(0, 80), about_suffix(*value)));
  for (const double x : *list)
    if (std::abs(x) > std::numeric_limits<float>::max())
      fail(loader, node, fmt::format("{} is beyond the range of numbers; rescale the scene", name));
  return {(*list)[0], (*list)[1], (*list)[2]};
}

DMat4 lookat_of(const Loader& loader, const Node& node) {
  const DVec3 origin = point_attribute(loader, node, "origin"), target = point_attribute(loader, node, "target");
  const DVec3 view = target - origin;
  if (!(glm::dot(view, view) > 0)) fail(loader, node, "origin and target are the same point; move one of them");
  const DVec3 z = glm::normalize(view);
  DVec3 up(0);
  if (const std::string* said = attribute(node, "up"); said && !said->empty()) up = point_attribute(loader, node, "up");
  if (!(glm::dot(up, up) > 0)) up = across(z, loader.document.old);
  const DVec3 left = glm::cross(up, z);
  if (!(glm::dot(left, left) > 1e-16 * glm::dot(up, up)))
    fail(loader, node, "up points along the line of sight; take another one, or leave it out");
  const DVec3 x = glm::normalize(left);
  DMat4 m(1);
  m[0] = {x, 0};
  m[1] = {glm::cross(z, x), 0};
  m[2] = {z, 0};
  m[3] = {origin, 1};
  return m;
}

DMat4 rotate_of(const Loader& loader, const Node& node) {
  const std::string* axis_words = attribute(node, "axis");
  const DVec3 axis = axis_words != nullptr ? point_attribute(loader, node, "axis") : vector_of(loader, node, 0);
  if (attribute(node, "angle") == nullptr) fail(loader, node, "needs angle=\"...\", in degrees");
  const double angle = number_attribute(loader, node, "angle", 0);
  if (glm::dot(axis, axis) > 0) return glm::rotate(DMat4(1), glm::radians(angle), glm::normalize(axis));
  if (angle != 0) fail(loader, node, "needs an axis: x, y, z or value=\"x, y, z\"");
  return DMat4(1);
}

DMat4 step_of(const Loader& loader, const Node& step) {
  if (step.tag == "matrix") return matrix_of(loader, step);
  if (step.tag == "lookat") return lookat_of(loader, step);
  if (step.tag == "rotate") return rotate_of(loader, step);
  if (step.tag == "translate" || step.tag == "point") return glm::translate(DMat4(1), vector_of(loader, step, 0));
  if (step.tag == "scale") return glm::scale(DMat4(1), vector_of(loader, step, 1));
  if (step.tag == "identity") return DMat4(1);
  fail(loader, step, "is unknown inside <transform>; known are translate, rotate, scale, lookat, matrix");
}

DMat4 affine_of(const Loader& loader, const Node& node) {
  DMat4 m = transform_of(loader, node);
  const double w = m[3][3];
  for (int column = 0; column < 3; ++column)
    if (std::abs(m[column][3]) > 1e-6 * std::abs(w))
      fail(loader, node, "is projective; Ajar takes affine ones, whose last row is 0 0 0 1");
  if (!(std::abs(w) > 0)) fail(loader, node, "is singular; the last number of a matrix should be 1");
  if (w != 1) m = m * (1 / w);
  return m;
}

// An affine map as a rotation after a stretch (polar decomposition), which can be blended.
struct Pose {
  DVec3 translation{0};
  glm::dquat rotation{1, 0, 0, 0};
  glm::dmat3 stretch{1};
};

Pose pose_of(const Loader& loader, const Node& node, const DMat4& m) {
  const glm::dmat3 linear(m);
  glm::dmat3 r = linear;
  // Newton's iteration for the orthogonal factor (Higham 1986).
  for (int i = 0; i < 100; ++i) {
    if (!(std::abs(glm::determinant(r)) > 0))
      fail(loader, node, "is singular; between keys of an <animation> every axis needs a scale");
    const glm::dmat3 next = 0.5 * (r + glm::inverse(glm::transpose(r)));
    double change = 0;
    for (int c = 0; c < 3; ++c) change = std::max(change, glm::length(next[c] - r[c]));
    r = next;
    if (change < 1e-14) break;
  }
  if (glm::determinant(r) < 0) r = -r;  // a mirror goes with the stretch
  return {DVec3(m[3]), glm::quat_cast(r), glm::transpose(r) * linear};
}

DMat4 blend(const Pose& a, const Pose& b, double share) {
  const glm::dmat3 linear =
      glm::mat3_cast(glm::slerp(a.rotation, b.rotation, share)) * (a.stretch * (1 - share) + b.stretch * share);
  DMat4 m(linear);
  m[3] = DMat4::col_type(glm::mix(a.translation, b.translation, share), 1);
  return m;
}

// The keys of an <animation>, in the order of their times.
std::map<double, const Node*> keys_of(Loader& loader, const Node& node) {
  std::map<double, const Node*> keys;
  for (const Node& key : node.children) {
    if (key.tag != "transform") fail(loader, key, "is unknown inside <animation>; it holds <transform time=\"...\">");
    if (attribute(key, "time") == nullptr) fail(loader, key, "needs time=\"...\"");
    const double time = number_attribute(loader, key, "time", 0);
    if (!keys.emplace(time, &key).second) fail(loader, key, "has the time of another <transform>");
    Hints& hints = loader.scene.hints;
    hints.first_time = std::min(hints.first_time, time), hints.last_time = std::max(hints.last_time, time);
  }
  if (keys.empty()) fail(loader, node, "needs <transform time=\"...\"> inside");
  return keys;
}

bool has_transform(const Params& params, const char* name) {
  return std::any_of(params.node.children.begin(), params.node.children.end(),
                     [&](const Node& child) { return child.tag == "transform" && child.name == name; });
}

// Those of instances had a name of their own once.
bool may_move(const Params& params, const Node& child, const char* name) {
  if (child.tag != "animation" && child.tag != "ref") return false;
  return child.name == name ||
         (!params.loader.document.old && child.name == "animation" && params.node.type == "instance");
}

// The transform at the loader's time: between two keys, rotations are blended along the shortest way. Before the first
// and after the last it rests.
DMat4 animated(Loader& loader, const Node& node) {
  const std::map<double, const Node*> keys = keys_of(loader, node);
  const double time = loader.time;
  const auto after = keys.lower_bound(time);
  if (after == keys.end()) return affine_of(loader, *std::prev(after)->second);
  const DMat4 b = affine_of(loader, *after->second);
  if (after == keys.begin() || after->first == time) return b;
  const auto before = std::prev(after);
  const DMat4 a = affine_of(loader, *before->second);
  if (a == b) return a;
  return blend(pose_of(loader, *before->second, a), pose_of(loader, *after->second, b),
               (time - before->first) / (after->first - before->first));
}

}  // namespace

DVec3 across(const DVec3& z, bool old) {
  if (!old) {
    const double sign = z.z < 0 ? -1 : 1, a = -1 / (sign + z.z);
    return {1 + sign * z.x * z.x * a, sign * z.x * z.y * a, -sign * z.x};
  }
  const DVec3 third = std::abs(z.x) > std::abs(z.y) ? DVec3(z.z, 0, -z.x) : DVec3(0, z.z, -z.y);
  return glm::cross(glm::normalize(third), z);
}

DMat4 transform_of(const Loader& loader, const Node& node) {
  DMat4 m(1);
  for (const Node& step : node.children) m = step_of(loader, step) * m;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!(std::abs(m[column][row]) <= std::numeric_limits<float>::max()))
        fail(loader, node, "its product is beyond the range of numbers; use smaller factors");
  return m;
}

DMat4 to_world(Params& params, const char* name) {
  for (size_t i = 0; i < params.node.children.size(); ++i) {
    const Node& child = params.node.children[i];
    if (!may_move(params, child, name)) continue;
    const Node& meant = follow(params.loader, child);
    if (meant.tag != "animation") continue;
    if (has_transform(params, name)) fail(params.loader, child, "stands beside a <transform>; one of them has to go");
    params.used[i] = true;
    return animated(params.loader, meant);
  }
  const Node* node = find(params, {name});
  if (node == nullptr) return DMat4(1);
  if (node->tag != "transform") fail(params.loader, *node, "should be a <transform>");
  return affine_of(params.loader, *node);
}

}  // namespace ajar
