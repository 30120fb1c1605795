// Names of parameters among thousands of them.
#include <algorithm>
#include <random>
#include <set>

#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

// Of many that begin alike, or are another's beginning; in every other round they stand below their uses.
TEST(Parameters, TheLongestNameIsMeantAmongMany) {
  std::mt19937 random(5);
  const auto word = [&](size_t most) {
    std::string out(1 + random() % most, 'a');
    for (char& c : out) c = "ab\xc3"[random() % 3];
    return out;
  };
  for (int round = 0; round < 50; ++round) {
    std::set<std::string> names = {"a", "b", "\xc3"};
    for (int i = 0; i < 20; ++i) names.insert(word(6));
    std::string defaults, uses;
    LoadOptions options;
    std::vector<std::string> expected;
    for (const std::string& name : names) {
      defaults += "<default name='" + name + "' value='(" + name + ")'/>";
      if (round % 2 == 0 && random() % 4 == 0) options.defines[name] = "(" + name + ")";
    }
    for (int i = 0; i < 20; ++i) {
      const std::string text = word(8);
      size_t longest = 0;
      for (const std::string& name : names)
        if (text.starts_with(name)) longest = std::max(longest, name.size());
      uses += "<shape type='cube' id='" + std::to_string(i) + "$" + text + "'/>";
      expected.push_back(std::to_string(i) + "(" + text.substr(0, longest) + ")" + text.substr(longest));
    }
    const Scene s = load_inside(round % 2 == 0 ? defaults + uses : uses + defaults, options);
    ASSERT_EQ(s.shapes.size(), expected.size());
    for (size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(s.shapes[i].name, expected[i]);
  }
}

}  // namespace
}  // namespace ajar
