#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace corridor::test {

/// Reads the data in a page, in the way in which the page's script reads them in a browser.
class PageReader {
 public:
  explicit PageReader(const std::string& page)
      : json(nlohmann::json::parse(element(page, "data"))) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : element(page, "buffers")) {
      if (c == '=') break;
      const std::size_t digit = digits.find(c);
      if (digit == std::string::npos) throw std::runtime_error("no base64");
      bits = bits << 6 | static_cast<std::uint32_t>(digit);
      if ((count += 6) >= 8) bytes_ += static_cast<char>(bits >> (count -= 8) & 255);
    }
  }

  /// Returns the array to which an entry such as ["f4", offset, count] refers.
  template <class Number>
  std::vector<Number> array(const nlohmann::json& view) const {
    const std::string type = view.at(0);
    const std::size_t offset = view.at(1), count = view.at(2);
    if (type == "f4") return converted<float, Number>(offset, count);
    if (type == "u4") return converted<std::uint32_t, Number>(offset, count);
    if (type == "u2") return converted<std::uint16_t, Number>(offset, count);
    if (type == "u1") return converted<std::uint8_t, Number>(offset, count);
    throw std::runtime_error("no type " + type);
  }

  nlohmann::json json;

 private:
  static std::string element(const std::string& page, const std::string& id) {
    const std::size_t begin = page.find('>', page.find("id=\"" + id + "\">")) + 1;
    return page.substr(begin, page.find("</script>", begin) - begin);
  }
  template <class Stored, class Number>
  std::vector<Number> converted(std::size_t offset, std::size_t count) const {
    if (offset % 4 != 0 || offset + count * sizeof(Stored) > bytes_.size())
      throw std::runtime_error("an array out of the buffer");
    std::vector<Stored> numbers(count);
    if (count) std::memcpy(numbers.data(), bytes_.data() + offset, count * sizeof(Stored));
    return {numbers.begin(), numbers.end()};
  }

  std::string bytes_;
};

}  // namespace corridor::test
