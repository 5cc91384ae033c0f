#pragma once

#include <atomic>
#include <filesystem>
#include <string>

namespace corridor {

/// Pictures of pages, by a browser without a display.

struct PictureSize {
  int width = 1366, height = 768;  ///< pixels
};
/// Of "1200x800", each from 100 to 8000. @param option for the fault. @throws InputError.
PictureSize pictureSize(const std::string& text, const std::string& option);

/// Chromium, by the names that it has in PATH.
/// @throws InputError, which names the option, where there is none.
std::filesystem::path requireBrowser(const std::string& option);

/// A PNG of a page of `viewPage`, without its panel and controls. The file appears whole or not at
/// all.
/// @param interrupted where it becomes true, the browser is ended. @returns false then.
/// @throws InputError where the browser can't draw it, or the file can't be written.
bool writePicture(const std::string& page, const std::filesystem::path& browser,
                  const PictureSize& size, const std::filesystem::path& file,
                  const std::atomic<bool>& interrupted);

}  // namespace corridor
