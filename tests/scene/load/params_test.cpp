// What all plugins have in common: numbers, parameters given twice or not asked for.
#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

TEST(Params, NumbersThatAreTooLargeAreToldFromWords) {
  const auto radius = [](const std::string& value) {
    return error_of("<shape type='sphere'><float name='radius' value='" + value + "'/></shape>");
  };
  for (const char* huge : {"1e39", "1e3000", " +1e3000"}) EXPECT_SAYS(radius(huge), "is beyond the range of numbers");
  for (const char* word : {"nan", "inf", "1e", "one", ""}) EXPECT_SAYS(radius(word), "is not a number");
}

TEST(Params, UnusedParametersAreNotedOnce) {
  const Scene s = load_inside(
      "<shape type='sphere'><boolean name='causticReceiver' value='true'/></shape>"
      "<shape type='sphere'><boolean name='causticReceiver' value='true'/></shape>");
  int count = 0;
  for (const std::string& note : s.notes) count += note.find("\"causticReceiver\"") != note.npos;
  EXPECT_EQ(count, 1);
}

TEST(Params, LastOfTwoParametersCounts) {
  const Scene s =
      load_inside("<bsdf type='roughplastic'><float name='alpha' value='.2'/><float name='alpha' value='.3'/></bsdf>");
  EXPECT_FLOAT_EQ(s.materials[0].alpha_u.value.x, 0.3f);
  EXPECT_TRUE(says(s.notes, "more than once"));
}

// Mitsuba 0.6 reads all numbers and colours of an element before its textures.
TEST(Params, TextureBesideColourCountsInOldScenes) {
  const std::string texture = "<texture name='reflectance' type='checkerboard'/>",
                    colour = "<rgb name='reflectance' value='.1'/>";
  const auto shown = [](const std::string& inside, const char* version) {
    return load_inside("<bsdf type='diffuse'>" + inside + "</bsdf>", {}, version);
  };
  for (const std::string& both : {texture + colour, colour + texture})
    EXPECT_NE(shown(both, "0.6.0").materials[0].reflectance.texture, none);
  EXPECT_TRUE(says(shown(texture + colour, "0.6.0").notes, "more than once: the texture counts"));
  EXPECT_EQ(shown(texture + colour, "3.0.0").materials[0].reflectance.texture, none);
  EXPECT_NE(shown(colour + texture, "3.0.0").materials[0].reflectance.texture, none);
}

}  // namespace
}  // namespace ajar
