#pragma once

#include <atomic>
#include <filesystem>
#include <string>

namespace corridor {

/// Pictures of the pages of `viewPage`, drawn by a browser without a display.

struct PictureSize {
  int width = 1366, height = 768;  ///< pixels
};
/// Reads a size such as "1200x800", with both numbers from 100 to 8000. @param option the option's
/// name for the error message. @throws InputError if the text is not such a size.
PictureSize pictureSize(const std::string& text, const std::string& option);

/// Searches PATH for Chromium by its usual names, and returns the path of the program.
/// @throws InputError, which names the option, if Chromium is not found.
std::filesystem::path requireBrowser(const std::string& option);

/// Writes a picture of a page of `viewPage` as a PNG, without the page's panel and controls. The
/// file is written completely or not at all.
/// @param interrupted when it becomes true, the browser is stopped. @returns false if the browser
/// was stopped for this reason, else true.
/// @throws InputError if the browser can't draw the page, or the file can't be written.
bool writePicture(const std::string& page, const std::filesystem::path& browser,
                  const PictureSize& size, const std::filesystem::path& file,
                  const std::atomic<bool>& interrupted);

}  // namespace corridor
