// Enters: the files of src/report/page/, which the build turns into text of the library (page/embed.cmake).
// Leaves: that text.
#pragma once

#include <span>
#include <string_view>

namespace ajar::page {

extern const std::string_view html;                      ///< the frame, with {{title}}, {{style}} ... to be filled in
extern const std::string_view style;                     ///< report.css
extern const std::span<const std::string_view> scripts;  ///< the .js files, in their order

}  // namespace ajar::page
