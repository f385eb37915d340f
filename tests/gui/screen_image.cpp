// SPDX-License-Identifier: BSD-3-Clause
#include "screen_image.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <stdexcept>

namespace psi_slam {

wxImage screen_image(const wxPoint& corner, const wxSize& size) {
  Display* const display = XOpenDisplay(nullptr);
  if (display == nullptr) throw std::runtime_error("no display");
  XImage* const shot =
      XGetImage(display, DefaultRootWindow(display), corner.x, corner.y, static_cast<unsigned>(size.x),
                static_cast<unsigned>(size.y), AllPlanes, ZPixmap);
  wxImage image(size.x, size.y);
  for (int y = 0; shot != nullptr && y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const unsigned long pixel = XGetPixel(shot, x, y);
      image.SetRGB(x, y, static_cast<unsigned char>(pixel >> 16), static_cast<unsigned char>(pixel >> 8),
                   static_cast<unsigned char>(pixel));
    }
  if (shot != nullptr) XDestroyImage(shot);
  XCloseDisplay(display);
  return image;
}

}  // namespace psi_slam
