// The text form of FBX. The binary form is not searched.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "collision/geometry/assimp_content_xml.h"

namespace corridor {
namespace {

/// Pairs parent/child: the elements that may be in another once, because assimp reads one of them.
/// The root's name is empty.
constexpr std::string_view kSingle =
    " /GlobalSettings /Definitions /Objects /Connections GlobalSettings/Properties70 "
    "Model/Properties70 Geometry/Vertices Geometry/PolygonVertexIndex Vertices/a "
    "PolygonVertexIndex/a ";

/// The properties that move geometry. Commas are before and after each name.
constexpr std::string_view kProperties =
    ",UpAxis,UpAxisSign,FrontAxis,FrontAxisSign,CoordAxis,CoordAxisSign,UnitScaleFactor,"
    "RotationOrder,RotationActive,InheritType,RotationOffset,RotationPivot,ScalingOffset,"
    "ScalingPivot,PreRotation,PostRotation,Lcl Translation,Lcl Rotation,Lcl Scaling,"
    "GeometricTranslation,GeometricRotation,GeometricScaling,";

/// Reads the elements "key: value, value { elements }" of a file. Faults of syntax are left to
/// assimp.
class FbxCheck {
 public:
  FbxCheck(const std::string& file, std::string_view text, ContentReport& report)
      : file_(file), text_(text), report_(report) {}

  void run() {
    // assimp ends at a NUL, and takes a form feed for the end of a line.
    if (const auto place = text_.find_first_of(std::string_view("\0\f\v", 3)); place != text_.npos)
      fault(1 + static_cast<int>(std::count(text_.begin(), text_.begin() + place, '\n')),
            "a character that text doesn't have: NUL, form feed or vertical tab; remove it");
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"') {
        const auto end = std::min(text_.find('"', at_ + 1), text_.size());
        addWord(text_.substr(at_ + 1, end - at_ - 1), end + 1);
      } else if (c == ';') {
        at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
      } else if (c == '{') {
        open_.push_back(std::move(element_));
        element_ = {};
        ++at_;
      } else if (c == '}') {
        finish();
        if (open_.empty()) return fault(line_, "a } without a {, where assimp ends; remove it");
        element_ = std::move(open_.back());
        open_.pop_back();
        finish();
        ++at_;
      } else if (c == ',' || c == ':' || isBlank(c)) {
        line_ += c == '\n';
        ++at_;
      } else {
        const auto end = std::min(text_.find_first_of(" \t\r\n,:;{}\"", at_), text_.size());
        const std::string_view word = text_.substr(at_, end - at_);
        const auto next = text_.find_first_not_of(" \t", end);
        if (next != text_.npos && text_[next] == ':')
          start(word, end);
        else
          addWord(word, end);
      }
    }
    finish();
    checkSkipped();
  }

 private:
  struct Element {
    std::string_view key;
    std::vector<std::string_view> values;
    int line = 0;
    std::set<std::string> single;  // what is in the element, and may be in it once
  };

  static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  void fault(int line, const std::string& text) { report_.fault(file_, line, text); }

  std::string_view around() const { return open_.empty() ? "" : open_.back().key; }

  void addWord(std::string_view word, std::size_t end) {
    element_.values.push_back(word);
    line_ += static_cast<int>(std::count(word.begin(), word.end(), '\n'));
    at_ = end;
  }

  void start(std::string_view key, std::size_t end) {
    finish();
    element_.key = key;
    element_.line = line_;
    at_ = end;
    const std::string place = std::string(around()) + '/' + std::string(key);
    if (isListed(kSingle, place)) requireFirst(std::string(key));
  }

  /// Adds a fault if something of the name is in the element around the current one already.
  void requireFirst(const std::string& name) {
    std::set<std::string>& single = open_.empty() ? single_ : open_.back().single;
    if (!single.insert(name).second)
      fault(element_.line, "a second \"" + name +
                               "\" is in one part of the file, and assimp drops one" + kInstead);
  }

  /// At the end of an element, or of what is between two elements.
  void finish() {
    const std::string_view name = element_.key == "a" ? around() : element_.key;
    if (name == "Vertices") checkNumbers(element_.values, name);
    if (name == "Vertices" && element_.key == "a") addExtent();
    if (isListed(" Vertices PolygonVertexIndex ", name) && element_.key == "a") checkCount(name);
    if (name == "PolygonVertexIndex") checkCorners();
    if (name == "P" && around() == "Properties70" && element_.values.size() > 4 &&
        movesGeometryOfFbx(element_.values[0])) {
      requireFirst(std::string(element_.values[0]));
      const std::vector<std::string_view> numbers(element_.values.begin() + 4,
                                                  element_.values.end());
      checkNumbers(numbers, element_.values[0]);
      if (element_.values[0] == "UnitScaleFactor") checkUnit(numbers);
      if (numbers.size() >= 3) checkIsApplied(numbers, element_.values[0]);
    }
    element_ = {};
  }

  /// Checks that assimp reads numbers as they are: it takes those of 32 characters or more for 0.
  void checkNumbers(const std::vector<std::string_view>& words, std::string_view name) {
    constexpr std::size_t kMostCharacters = 31;
    double largest = 0;
    for (const std::string_view word : words)
      if (const double number = numberIn(word); !std::isnan(number))
        largest = std::max(largest, std::abs(number));
    for (const std::string_view word : words) {
      if (word.starts_with('*')) continue;  // the size of a list
      const std::string start = std::string(name) + " has \"" + std::string(word.substr(0, 64));
      const double number = numberIn(word);
      if (std::isnan(number))
        return fault(element_.line, start + "\", which is no decimal number" + kDecimals);
      if (word.size() > kMostCharacters || !isReadRightly(word, number, largest))
        return fault(element_.line, start + '"' + kDigits);
    }
  }

  /// Checks that a list such as "Vertices: *3 { a: 0,0,0 }" has as many values as it says.
  void checkCount(std::string_view name) {
    const std::vector<std::string_view>& head = open_.back().values;
    if (head.size() != 1 || !head[0].starts_with('*') ||
        wholeNumberIn(head[0].substr(1)) == static_cast<long>(element_.values.size()))
      return;
    fault(element_.line, std::string(name) + " has " + std::to_string(element_.values.size()) +
                             " values and says " + std::string(head[0].substr(1, 20)) +
                             "; the file may be cut off, save it again");
  }

  void addExtent() {
    double largest = 0;
    for (const std::string_view word : element_.values)
      if (const double number = numberIn(word); !std::isnan(number))
        largest = std::max(largest, std::abs(number));
    extent_ = std::min(extent_, largest);
  }

  /// Checks that the unit is positive. assimp drops others.
  void checkUnit(const std::vector<std::string_view>& words) {
    if (!words.empty() && numberIn(words[0]) <= 0)
      fault(element_.line,
            "UnitScaleFactor is not above 0; write the length of a unit in centimetres");
  }

  /// Checks that assimp applies a transform of three numbers. It skips those whose difference from
  /// the identity has a square of at most 2^-23 in floats.
  void checkIsApplied(const std::vector<std::string_view>& words, std::string_view name) {
    // The float of a scale near 1 is off by 2^-24, which is 1.73e-4 of the limit's root, 2^-11.5.
    // Three components make at most sqrt(3) of that, and the square twice: 6.0e-4. The sum's own
    // roundings are below 1e-6.
    constexpr double kMostSkipped = 0x1p-23 * 1.001;
    const bool isScale = name.ends_with("Scaling"), isTurn = name.ends_with("Rotation");
    double square = 0, least = 1;
    for (std::size_t i = 0; i < 3; ++i) {
      const double number = numberIn(words[i]), difference = number - (isScale ? 1 : 0);
      square += difference * difference;
      least = std::min(least, std::abs(number));
    }
    if (isScale) scales_ *= least;
    if (!(square > 0 && square <= kMostSkipped)) return;
    // Scales and turns (in degrees) of a rounding of floats move a vertex by that share of its
    // distance, which is the precision of all that assimp reads.
    constexpr double kRounding = 0x1p-23;
    const double size = std::sqrt(square);
    if (isScale ? size <= kRounding : isTurn && size <= kRounding * 180 / std::numbers::pi)
      report_.note(kNoteOnSkipped);
    else
      skipped_.push_back({element_.line, std::string(name), isScale || isTurn ? HUGE_VAL : size});
  }

  /// Adds faults for the transforms that assimp skips and that are no roundings. A length is one if
  /// it is below the rounding to floats of each geometry's largest coordinate, also after all of
  /// the file's scales that are below 1.
  void checkSkipped() {
    for (const auto& [line, name, size] : skipped_)
      if (size <= 0x1p-24 * extent_ * scales_)
        report_.note(kNoteOnSkipped);
      else
        fault(line, name +
                        " is so near the identity that assimp does not apply it; apply it in the "
                        "modeller, or write the identity");
  }

  /// Checks the corners of polygons, of which the last has a negative number.
  void checkCorners() {
    std::string_view last = "-1";
    for (const std::string_view word : element_.values) {
      if (word.starts_with('*')) continue;
      if (wholeNumberIn(word.substr(word.starts_with('-'))) < 0)
        return fault(element_.line,
                     "PolygonVertexIndex may have whole numbers only, with at most 31 bits");
      last = word;
    }
    if (!last.starts_with('-') || numberIn(last) == 0)
      fault(element_.line,
            "the last polygon does not end, and assimp drops it; make its last corner negative");
  }

  const std::string& file_;
  std::string_view text_;
  ContentReport& report_;
  std::size_t at_ = 0;
  int line_ = 1;
  Element element_;            // the current one
  std::vector<Element> open_;  // those around it
  std::set<std::string> single_;

  struct Skipped {
    int line;
    std::string name;
    double size;
  };
  static constexpr const char* kNoteOnSkipped =
      "transforms of FBX that differ from the identity by roundings only are not applied";
  std::vector<Skipped> skipped_;  // the transforms that assimp does not apply
  double extent_ = HUGE_VAL;      // the least of the geometries' largest coordinates
  double scales_ = 1;             // the product of the scales below 1
};

}  // namespace

bool movesGeometryOfFbx(std::string_view property) {
  return kProperties.find("," + std::string(property) + ",") != kProperties.npos;
}

void checkFbx(const std::string& file, std::string_view text, ContentReport& report) {
  if (text.starts_with("Kaydara FBX Binary"))
    report.note(
        "a binary FBX file is not searched for parts that are there twice, or transforms that "
        "assimp does not apply; a text file is");
  else
    FbxCheck(file, text, report).run();
}

}  // namespace corridor
