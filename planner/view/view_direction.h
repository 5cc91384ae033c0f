#pragma once

#include <string>

namespace corridor {

/// The direction from the scene to the viewer of a picture.
struct ViewDirection {
  double azimuth = 0;    ///< about z, from x towards y, rad
  double elevation = 0;  ///< above the ground, rad
};

/// Reads a direction: front (the viewer is at +x), back, left (at +y), right, top, bottom, or
/// AZIMUTH,ELEVATION in degrees, such as "-60,38". @param option the option's name in the error
/// message.
/// @throws InputError if the text is not a direction.
ViewDirection viewDirection(const std::string& text, const std::string& option);

}  // namespace corridor
