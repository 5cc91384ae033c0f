#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <yaml.h>

namespace corridor {

/// Returns the index of the byte at which a column of a line begins. libyaml counts columns in
/// characters, from 0.
std::size_t byteOfColumn(std::string_view line, std::size_t column);

/// The events of a YAML text, by libyaml: the starts and ends of documents, lists and maps, and the
/// texts. (libyaml.org; YAML 1.1 and 1.2.)
class YamlEvents {
 public:
  struct Fault {
    int line = 0;      ///< from 0
    std::string text;  ///< for users
  };

  /// @param text in UTF-8, with LF as line ends, or in UTF-16. It must outlive this object.
  explicit YamlEvents(std::string_view text);
  YamlEvents(const YamlEvents&) = delete;
  YamlEvents& operator=(const YamlEvents&) = delete;
  ~YamlEvents();

  /// Returns the next event, which is valid until the next call; null at the end of the text, and
  /// from the first fault on.
  const yaml_event_t* next();
  const std::optional<Fault>& fault() const { return fault_; }

 private:
  Fault explained() const;

  std::string_view text_;
  yaml_parser_t parser_;
  yaml_event_t event_;
  bool isDone_ = false;
  std::optional<Fault> fault_;
};

}  // namespace corridor
