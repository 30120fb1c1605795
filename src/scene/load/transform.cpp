#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>

#include "loader.h"

namespace ajar {
namespace {

DMat4 matrix_of(const Loader& loader, const Node& node) {
  const std::string* value = attribute(node, "value");
  const auto list = value == nullptr ? std::nullopt : to_numbers(*value);
  if (!list || (list->size() != 16 && list->size() != 9))
    fail(loader, node, "needs value=\"...\" of 16 (or 9) numbers, row by row");
  const int n = list->size() == 16 ? 4 : 3;
  DMat4 m(1);
  for (int row = 0; row < n; ++row)
    for (int column = 0; column < n; ++column) m[column][row] = (*list)[size_t(row * n + column)];
  return m;
}

DVec3 point_attribute(const Loader& loader, const Node& node, const char* name) {
  const std::string* value = attribute(node, name);
  const auto list = value == nullptr ? std::nullopt : to_numbers(*value);
  if (!list || list->size() != 3) fail(loader, node, fmt::format("needs {}=\"x, y, z\"", name));
  return {(*list)[0], (*list)[1], (*list)[2]};
}

DMat4 lookat_of(const Loader& loader, const Node& node) {
  const DVec3 origin = point_attribute(loader, node, "origin"), target = point_attribute(loader, node, "target");
  const DVec3 view = target - origin;
  if (!(glm::dot(view, view) > 0)) fail(loader, node, "origin and target are the same point");
  const DVec3 z = glm::normalize(view);
  DVec3 up = std::abs(z.y) < 0.9 ? DVec3(0, 1, 0) : DVec3(0, 0, 1);
  if (attribute(node, "up") != nullptr) up = point_attribute(loader, node, "up");
  const DVec3 left = glm::cross(up, z);
  if (!(glm::dot(left, left) > 1e-16 * glm::dot(up, up))) fail(loader, node, "up points along the line of sight");
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
  if (!(glm::dot(axis, axis) > 0)) fail(loader, node, "needs an axis: x, y, z or value=\"x, y, z\"");
  return glm::rotate(DMat4(1), glm::radians(number_attribute(loader, node, "angle", 0)), glm::normalize(axis));
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

}  // namespace

DMat4 transform_of(const Loader& loader, const Node& node) {
  DMat4 m(1);
  for (const Node& step : node.children) m = step_of(loader, step) * m;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!(std::abs(m[column][row]) <= std::numeric_limits<float>::max()))
        fail(loader, node, "its product is beyond the range of numbers");
  return m;
}

DMat4 to_world(Params& params, const char* name) {
  for (const Node& child : params.node.children)
    if (child.tag == "animation" && child.name == name)
      fail(params.loader, child, "moving objects are not supported; give one <transform>");
  const Node* node = find(params, {name});
  if (node == nullptr) return DMat4(1);
  if (node->tag != "transform") fail(params.loader, *node, "should be a <transform>");
  DMat4 m = transform_of(params.loader, *node);
  const double w = m[3][3];
  for (int column = 0; column < 3; ++column)
    if (std::abs(m[column][3]) > 1e-6 * std::abs(w))
      fail(params.loader, *node, "is projective; Ajar takes affine ones");
  if (!(std::abs(w) > 0)) fail(params.loader, *node, "is singular");
  if (w != 1) m = m * (1 / w);
  return m;
}

bool is_similarity(const DMat4& m) {
  const DVec3 x(m[0]), y(m[1]), z(m[2]);
  const double size = glm::dot(x, x), slack = 2e-4 * size;
  return std::abs(glm::dot(y, y) - size) < slack && std::abs(glm::dot(z, z) - size) < slack &&
         std::abs(glm::dot(x, y)) < slack && std::abs(glm::dot(y, z)) < slack && std::abs(glm::dot(z, x)) < slack;
}

}  // namespace ajar
