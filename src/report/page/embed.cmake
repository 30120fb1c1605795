# Makes a C++ source of the page's files, a literal of each.
# Usage: cmake -DFOLDER=<this folder> -DSCRIPTS=<a.js,b.js> -DOUT=<source.cpp> -P embed.cmake
cmake_minimum_required(VERSION 3.22)

function(literal file out)
  file(READ ${FOLDER}/${file} text)
  set(${out} "R\"page(${text})page\"" PARENT_SCOPE)
endfunction()

literal(report.html html)
literal(report.css style)
set(list "")
string(REPLACE "," ";" files "${SCRIPTS}")
foreach(file ${files})
  literal(${file} script)
  string(APPEND list "    ${script},\n")
endforeach()
file(WRITE ${OUT} "#include \"report/page_parts.h\"

namespace ajar::page {
namespace {
const std::string_view files[] = {\n${list}};
}
const std::string_view html = ${html};
const std::string_view style = ${style};
const std::span<const std::string_view> scripts = files;
}  // namespace ajar::page
")
