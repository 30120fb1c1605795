// libFuzzer's entry point for scene files: every text either loads or ends in ajar::Error, strict and lenient.
#include "ajar/core/error.h"
#include "ajar/scene/load.h"
#include "kit/files.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const bool lenient : {false, true}) {
    ajar::LoadOptions options;
    options.lenient = lenient;
    try {
      ajar::load_scene_text(text, ajar::kit::source_path("tests/scene/load/assets"), "fuzz.xml", options);
    } catch (const ajar::Error&) {
    }
  }
  return 0;
}
