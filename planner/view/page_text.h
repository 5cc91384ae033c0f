#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

namespace corridor::view {

/// Functions for the text of an HTML page that contains all its data.

/// Escapes text for HTML, between tags or in quotes.
std::string escapedHtml(std::string_view text);
/// Escapes JSON for a <script> element: `<` is written as an escape of JSON, so that neither
/// `</script>` nor `<!--` can occur.
std::string scriptJson(std::string json);
/// Encodes bytes by RFC 4648, with padding.
std::string base64(std::span<const char> bytes);
/// Returns the template `text` with each `{{key}}` replaced by its value. Values are inserted
/// unchanged, and not searched for keys.
/// @throws std::logic_error for a key without a value, or a value whose key does not occur.
std::string filled(std::string_view text, const std::map<std::string, std::string>& values);

}  // namespace corridor::view
