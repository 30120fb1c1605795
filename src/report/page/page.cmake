# The page of the bench report, as a source of the library: the installed program needs no files.
set(page ${CMAKE_CURRENT_LIST_DIR})
set(scripts base.js numbers.js series.js plot.js summary.js curves.js reach.js bars.js estimate.js image.js view.js
    comparer.js pyramid.js main.js)
list(TRANSFORM scripts PREPEND ${page}/ OUTPUT_VARIABLE paths)
list(JOIN scripts "," names)
set(source ${CMAKE_CURRENT_BINARY_DIR}/page_parts.cpp)
add_custom_command(
  OUTPUT ${source}
  COMMAND ${CMAKE_COMMAND} -DFOLDER=${page} -DSCRIPTS=${names} -DOUT=${source} -P ${page}/embed.cmake
  DEPENDS ${page}/embed.cmake ${page}/report.html ${page}/report.css ${paths}
  VERBATIM)
target_sources(ajar_report PRIVATE ${source})
target_include_directories(ajar_report PRIVATE ${PROJECT_SOURCE_DIR}/src)
