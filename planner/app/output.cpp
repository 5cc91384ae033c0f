#include "planner/app/output.h"

#include <cstdio>
#include <iostream>
#include <unistd.h>

namespace corridor::app {

void Lines::line(std::string_view key, const std::string& value, Tone tone) const {
  if (quiet_) return;
  static const bool colour = ::isatty(STDOUT_FILENO) != 0;
  const char* on = !colour              ? ""
                   : tone == Tone::good ? "\033[32m"
                   : tone == Tone::bad  ? "\033[31m"
                                        : "";
  std::cout << key << ": " << on << value << (*on ? "\033[0m" : "") << '\n';
}

void Lines::blank() const {
  if (!quiet_) std::cout << '\n';
}

void warn(const std::string& text) {
  std::cerr << "corridor: warning: " << text << '\n';
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string rounded(const Vec3& v, int dimension) {
  std::string text = "[";
  for (int i = 0; i < dimension; ++i) text += (i ? ", " : "") + rounded(v[i]);
  return text + "]";
}

std::string grouped(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (auto at = static_cast<int>(text.size()) - 3; at > 0; at -= 3)
    text.insert(static_cast<std::size_t>(at), ",");
  return text;
}

std::string counted(std::uint64_t count, const std::string& noun) {
  return grouped(count) + " " + noun + (count == 1 ? "" : "s");
}

}  // namespace corridor::app
