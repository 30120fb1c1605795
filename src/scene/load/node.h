// Enters: the text of a scene file and of the files it includes.
// Leaves: one tree of elements with one spelling of every name, parameters put in, and the place where each was
// written.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ajar {

/// An element. Tag and name are in snake_case, type in small letters; `written` and `named` keep type and name as the
/// author spelt them.
struct Node {
  std::string tag, type, name, id, written, named;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< the others, names in snake_case
  std::vector<Node> children;
  uint32_t file = 0, line = 0;  ///< Document::files, counted from 1
};

struct Document {
  Node root;                            ///< <scene>, included files and all
  std::vector<std::string> files;       ///< as they stand in messages
  std::vector<std::string> folders;     ///< where relative names are looked for, in this order
  std::map<std::string, Node> aliases;  ///< <alias>: by the new name; its id is the other one
  std::vector<std::string> notes;
  std::vector<uint64_t> sums;  ///< checksums of the texts of the files
  uint64_t content = 0;        ///< checksum of all of them
  bool old = false;            ///< version 0.x, and no to_world in the scene's file: a few defaults differ
  bool by_name = false;        ///< versions from 2 to 3.6: nested bsdfs come in the order of their names
  /// Folders that a name in other capitals was looked for in, kept by find_file: their names by those in small letters.
  mutable std::map<std::string, std::map<std::string, std::string>> listings;
};

/// Reads a scene. name stands in messages, folder resolves relative names. Throws Error.
Document read_document(const std::string& text, const std::string& folder, const std::string& name,
                       const std::map<std::string, std::string>& defines);

/// toWorld, intIOR, alphaU -> to_world, int_ior, alpha_u; names in that spelling stay.
std::string snake_case(const std::string& name);
std::string lower(std::string text);
/// Whole file as bytes. Throws Error with the reason.
std::string read_text(const std::string& path);
/// Without the byte order mark that Windows puts before UTF-8.
std::string_view without_mark(std::string_view text);
/// Adds the text of a file to Document::sums and Document::content.
void count_text(Document& document, const std::string& text);
/// A message without line breaks, whatever was quoted in it.
std::string one_line(std::string text);
/// The text, or the beginning of a long one: what a message shows of a name.
std::string shortened(const std::string& text);
/// The attribute's value, or nullptr.
const std::string* attribute(const Node& node, const char* name);
/// "scene.xml:41: <bsdf type="foo">", the beginning of every message about an element.
std::string place(const Document& document, const Node& node);
/// What is wrong with a file that begins with this text where it stands for another one; empty where it does not.
std::string pointer_problem(std::string_view head);
/// What to say where find_file finds nothing.
std::string missing_file(const Document& document, const Node& node, const std::string& name);
/// The regular file that a name means, in the document's folders, beside the file that holds the element, or in the
/// working folder: as it stands, with / for \, or, in version 0.x, in other capitals; or the first that may not be
/// looked at. Empty if there is none.
std::string find_file(const Document& document, const Node& node, const std::string& name);

}  // namespace ajar
