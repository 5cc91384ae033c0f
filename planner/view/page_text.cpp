#include "planner/view/page_text.h"

#include <array>
#include <cstdint>
#include <set>
#include <stdexcept>

namespace corridor::view {

std::string escapedHtml(std::string_view text) {
  std::string html;
  for (const char c : text) switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  return html;
}

std::string scriptJson(std::string json) {
  // In JSON, `<` occurs only inside strings, where the escape is legal.
  for (std::size_t at = json.find('<'); at != std::string::npos; at = json.find('<', at))
    json.replace(at, 1, "\\u003c");
  return json;
}

std::string base64(std::span<const char> bytes) {
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[three >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string filled(std::string_view text, const std::map<std::string, std::string>& values) {
  std::string page;
  std::set<std::string> asked;
  for (;;) {
    const std::size_t begin = text.find("{{"), end = text.find("}}", begin);
    if (begin == std::string_view::npos || end == std::string_view::npos) break;
    const std::string key(text.substr(begin + 2, end - begin - 2));
    const auto value = values.find(key);
    if (value == values.end()) throw std::logic_error("a page has no value for {{" + key + "}}");
    page.append(text.substr(0, begin)).append(value->second);
    asked.insert(key);
    text.remove_prefix(end + 2);
  }
  for (const auto& [key, value] : values)
    if (!asked.count(key)) throw std::logic_error("a page does not use {{" + key + "}}");
  return page.append(text);
}

}  // namespace corridor::view
