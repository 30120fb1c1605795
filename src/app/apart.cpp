#include "apart.h"

#include <fmt/format.h>

#include <map>

#include "ajar/core/error.h"
#include "arguments.h"

namespace ajar {
namespace {

[[noreturn]] void refuse(const Named& output, const Named& other) {
  throw Error(fmt::format("{} {}: is the same file as {} {}; name another", output.option, output.path, other.option,
                          other.path));
}

}  // namespace

std::vector<Named> files_of(const Scene& scene) {
  std::vector<Named> out;
  for (const std::string& file : scene.files) out.push_back({"a file of the scene,", file});
  return out;
}

void require_apart(const Named& output, const Named& other) {
  if (is_same_file(output.path, other.path)) refuse(output, other);
}

void require_apart(const std::vector<Named>& outputs, const std::vector<Named>& read) {
  std::map<std::string, const Named*> places;
  for (const Named& input : read) places.emplace(place_of(input.path), &input);
  for (const Named& output : outputs)
    if (const auto [there, is_new] = places.emplace(place_of(output.path), &output); !is_new)
      refuse(output, *there->second);
}

}  // namespace ajar
