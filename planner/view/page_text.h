#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace corridor::view {

/// Pieces of pages: HTML of one file that loads nothing.

/// Text in HTML, between tags or in quotes.
std::string escapedHtml(std::string_view text);
/// JSON within <script>: what `<` starts (`</script>`, `<!--`) is said in JSON's own escapes.
std::string scriptJson(std::string json);
/// RFC 4648, with padding.
std::string base64(std::span<const char> bytes);
/// The template with each `{{key}}` replaced by its value, as it is.
/// @throws std::logic_error for a key without a value, or a value that no key asks for.
std::string filled(std::string_view text, const std::map<std::string, std::string>& values);

}  // namespace corridor::view
