// DOCTYPEs: entities that stand for text and for files.
#include "scene/load/entities.h"
#include "scene_text.h"

namespace ajar {
namespace {

using namespace kit;

std::string with_doctype(const std::string& declared, const std::string& text) {
  return "<!DOCTYPE scene [" + declared + "]>" + text;
}
std::string expanded(const std::string& declared, const std::string& text) {
  return expand_entities(with_doctype(declared, text), assets(), "a.xml");
}
std::string error_in(const std::string& text) {
  return kit::error_of([&] { expand_entities(text, assets(), "a.xml"); });
}
std::string wrong(const std::string& declared, const std::string& text) {
  return error_in(with_doctype(declared, text));
}
Scene load(const std::string& doctype, const std::string& inside) {
  return load_scene_text(doctype + "<scene version='0.6.0'>" + camera_text + inside + "</scene>", assets(), "a.xml");
}

TEST(Entities, StandForTextAndFiles) {
  const std::string head =
      "<?xml version='1.0'?>\n<!-- a [ -->\n<!DOCTYPE scene SYSTEM 'mitsuba.dtd' [\n<!-- <!ENTITY grey '0.9'> -->\n"
      "<!ENTITY % part ']>'>\n<!ELEMENT scene (bsdf)>\n<!ENTITY grey \"&digit;5\">\n<!ENTITY digit '0.2'>\n"
      "<!ENTITY grey '0.7'>\n<!ENTITY header SYSTEM 'entity.xml'> ]>\n";
  const Scene s = load(head, "&header;<shape type='sphere'><ref id='m'/></shape>");
  EXPECT_RGB(s.materials[s.shapes.at(0).material].reflectance.value, 0.25, 0.25, 0.25, 1e-6);
}

TEST(Entities, LeaveTheRestAsItIs) {
  const std::string plain = "<scene a='&lt;&amp; & b'><!-- &r; -->&#10;</scene>";
  EXPECT_EQ(expand_entities(plain, "", "a.xml"), plain);
  const std::string rest = "><s a='&lt; &amp; &#10; & b'><!-- &r; --><![CDATA[&r;]]></s>";
  EXPECT_EQ(expanded("<!ENTITY r '1'>", rest), "<!DOCTYPE scene [<!ENTITY r '1'>]>" + rest);
}

TEST(Entities, KeepTheLines) {
  EXPECT_EQ(expanded("\n<!ENTITY r 'a\nb'>", "\n&r;\n"), "<!DOCTYPE scene [\n<!ENTITY r 'a\nb'>]>\na b\n");
  try {
    load("<!DOCTYPE scene [\n<!ENTITY grey '1'>\n<!ENTITY header SYSTEM 'entity.xml'>]>\n", "&header;\n<gadget/>");
    FAIL();
  } catch (const Error& error) {
    EXPECT_SAYS(std::string(error.what()), "a.xml:6: <gadget>");
  }
}

TEST(Entities, WrongOnesAreErrors) {
  EXPECT_SAYS(wrong("<!ENTITY r '1'>", "\n\n&s;"), "a.xml:3: the entity &s; is declared in no DOCTYPE");
  EXPECT_SAYS(wrong("<!ENTITY a '&b;'><!ENTITY b '&a;'>", "&a;"), "&a; contains itself");
  EXPECT_SAYS(wrong("<!ENTITY h SYSTEM 'nowhere.xml'>", "&h;"), "the entity &h; cannot be put in: ");
  EXPECT_SAYS(wrong("<!ENTITY h SYSTEM 'nowhere.xml'>", "&h;"), "nowhere.xml: there is no such file");
  EXPECT_SAYS(wrong("<!ENTITY h SYSTEM '.'>", "&h;"), "is a folder");
  EXPECT_EQ(wrong("<!ENTITY h SYSTEM 'nowhere.xml'>", ""), "");  // not used
  EXPECT_SAYS(error_in("<scene>\n<shape type='&f;'/></scene>"), "a.xml:2: the entity &f; is declared in no DOCTYPE");
}

TEST(Entities, ExplosionIsStopped) {
  for (const std::string seed : {"", "x"}) {
    std::string declared = "<!ENTITY a0 '" + seed + "'>";
    for (int i = 1; i < 30; ++i) {
      std::string text;
      for (int k = 0; k < 10; ++k) text += "&a" + std::to_string(i - 1) + ";";
      declared += "<!ENTITY a" + std::to_string(i) + " '" + text + "'>";
    }
    EXPECT_SAYS(wrong(declared, "&a29;"), "makes more than 100000 references");
  }
  const std::string large = "<!ENTITY l '" + std::string(33 << 20, 'x') + "'>";
  EXPECT_SAYS(wrong(large, "&l;&l;"), "grow by more than 64 MB");
  std::string chain = "<!ENTITY a0 'x'>";
  for (int i = 1; i < 1000; ++i) chain += "<!ENTITY a" + std::to_string(i) + " '&a" + std::to_string(i - 1) + ";'>";
  EXPECT_SAYS(wrong(chain, "&a999;"), "nested more than 32 deep");
}

// Every beginning of a text ends somehow.
TEST(Entities, TornTextsEnd) {
  const std::string whole =
      "<?xml?><!DOCTYPE a PUBLIC \"b\" 'c' [<!--d--><!ENTITY % e 'f'><!ENTITY g \"&h;\"><!ENTITY h PUBLIC 'i' 'j' "
      "NDATA k>"
      "<!ENTITY l SYSTEM \"halves.obj\">]><m n='&l;&#1;'><!-- & --><![CDATA[o]]></m>";
  for (size_t n = 0; n <= whole.size(); ++n) EXPECT_NO_THROW(expand_entities(whole.substr(0, n), assets(), "a.xml"));
}

}  // namespace
}  // namespace ajar
