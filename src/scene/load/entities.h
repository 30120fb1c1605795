// Enters: the text of an XML file.
// Leaves: the same, with the entities that its DOCTYPE declares put in.
#pragma once

#include <string>

namespace ajar {

/// Puts in <!ENTITY name "text"> and <!ENTITY name SYSTEM "file">, the file named from `folder`, wherever &name;
/// stands. Line breaks in what is put in become blanks, so that lines keep their numbers. A text without a DOCTYPE
/// stays as it is. Throws Error "name:line: ..." about an entity that is not declared, contains itself or grows beyond
/// measure.
std::string expand_entities(const std::string& text, const std::string& folder, const std::string& name);

}  // namespace ajar
