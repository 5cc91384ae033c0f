#pragma once

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "collision/geometry/assimp_content.h"

/// The search of formats that are based on XML: Collada and the model of 3MF.
namespace corridor {

/// What is accepted of a format. Lists have a blank before and after each name.
struct XmlRules {
  std::string_view root;
  std::string_view accepted;  ///< the elements that are read, or cannot matter; empty: all others
  std::string_view refused;
  std::string_view numbered;  ///< elements with an `id` of their own (`requireOwnId`)
  std::string_view single;    ///< elements that may be in another once: assimp drops all but one
  std::string_view places;  ///< pairs child/parent: the only parents in which assimp reads a child
};

struct XmlTag {
  std::string_view name, attributes;
  std::string_view content;  ///< what is between an element's tags; set when it ends
  bool isEnd = false, isEmpty = false;
  int line = 0;
  std::size_t from = 0, to = 0;  ///< the tag's place in the file
  std::string single;            ///< those of `XmlRules::single` that are in the element

  /// Returns the value of an attribute; nullopt without it.
  std::optional<std::string_view> find(std::string_view attribute) const;
  /// Returns the name of an attribute that differs from the given one in the case of its letters
  /// only; nullopt if there is none.
  std::optional<std::string_view> findInOtherCase(std::string_view attribute) const;
  /// Returns the names of the attributes, in their order.
  std::vector<std::string_view> names() const;
  /// Returns the value of an attribute; "" without it.
  std::string_view value(std::string_view attribute) const { return find(attribute).value_or(""); }
};

/// Returns the tag that begins at a place of the text; its line is 0.
XmlTag xmlTagAt(std::string_view text, std::size_t at);
/// Returns whether a list such as " a b " has a name.
bool isListed(std::string_view list, std::string_view name);
/// Returns the text without the blanks and line ends around it.
std::string_view withoutBlanks(std::string_view text);
/// Returns the next word between the blanks of a text, and removes it; "" at the end.
std::string_view takeWord(std::string_view& text);
/// Returns the finite number that is all of a text except blanks; NaN if there is none.
double numberIn(std::string_view text);
/// Returns the numbers between the blanks of a text; NaN for each word that is none.
std::vector<double> numbersIn(std::string_view text);
/// Returns the whole number from 0 to 2^31 - 1 that is all of a text except blanks; -1 if there is
/// none.
long wholeNumberIn(std::string_view text);

constexpr const char* kInstead = "; save the mesh as OBJ, STL, PLY or OFF";
constexpr const char* kDecimals = "; write decimal numbers such as -1.25e-3";
constexpr const char* kDigits =
    ", which assimp misreads; write decimal numbers with at most 15 digits";

/// Reads a file once, and adds a fault for each element that breaks the rules. A derived class adds
/// the checks of its format. Faults of syntax are left to assimp.
class XmlCheck {
 public:
  XmlCheck(const XmlRules& rules, const std::string& file, std::string_view text,
           ContentReport& report)
      : rules_(rules), file_(file), text_(text), report_(report) {}
  virtual ~XmlCheck() = default;
  XmlCheck(const XmlCheck&) = delete;
  XmlCheck& operator=(const XmlCheck&) = delete;

  void run();

 protected:
  /// At the start of an element. `open_` has the elements around it.
  virtual void enter(const XmlTag&) {}
  /// At the end of an element, which is the last of `open_`.
  virtual void leave(const XmlTag&) {}
  virtual void end() {}
  /// For a file that is no complete XML file of the root.
  virtual void malformed() {}
  virtual bool isAccepted(std::string_view name) const;

  void fault(int line, const std::string& text) { report_.fault(file_, line, text); }
  /// Returns the name of the element around the one that starts (0), or that around it (1) …; "" if
  /// there is none. In `leave`, 0 is the element itself.
  std::string_view around(std::size_t steps) const {
    return steps < open_.size() ? open_[open_.size() - 1 - steps].name : std::string_view();
  }
  /// Adds a fault for each attribute whose name differs from one of the names in case only: it is
  /// not read.
  void checkCase(const XmlTag& tag, std::initializer_list<std::string_view> names);
  /// Adds a fault if a tag has an attribute twice: assimp reads one of them.
  void checkTwice(const XmlTag& tag);
  /// Adds a fault if an earlier element of the same name has the same `id`: assimp drops one.
  void requireOwnId(const XmlTag& tag);

  const XmlRules& rules_;
  const std::string& file_;
  std::string_view text_;
  ContentReport& report_;
  std::vector<XmlTag> open_;   // the elements around the current place
  std::set<std::string> ids_;  // of `requireOwnId`, or of a format's own check

 private:
  void start(XmlTag tag);
  void finish();
  std::optional<XmlTag> next();
  void skipTo(std::string_view end);

  static constexpr std::size_t kNone = std::string::npos;

  std::size_t at_ = 0;
  std::size_t counted_ = 0;  // the lines up to this place are counted in `line_`
  int line_ = 1;
  std::size_t refused_ = kNone;  // the depth of the element that is refused, around the current one
};

/// Checks the model in a 3MF archive.
void checkThreeMfModel(const std::string& file, std::string_view text, ContentReport& report);

}  // namespace corridor
