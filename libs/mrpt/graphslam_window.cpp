// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/graphslam_window.h"

#include <mrpt/opengl/COpenGLScene.h>

#include <chrono>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

void expect_display() {
  const char* const display = std::getenv("DISPLAY");
  if (display == nullptr || *display == '\0')
    throw UserError(
        "no display for the window: DISPLAY is not set. Run without window by --disable-visuals.");
}

}  // namespace

GraphSlamWindow::GraphSlamWindow() {
  constexpr unsigned kWidth_px = 800;
  constexpr unsigned kHeight_px = 600;
  expect_display();
  window_ = std::make_unique<mrpt::gui::CDisplayWindow3D>("psi-graphslam", kWidth_px, kHeight_px);
  observer_.observeBegin(*window_);
  observer_.observeBegin(*window_->get3DSceneAndLock()->getViewport("main"));
  window_->unlockAccess3DScene();
  manager_.setCDisplayWindow3DPtr(window_.get());
  manager_.setWindowObserverPtr(&observer_);
}

GraphSlamWindow::~GraphSlamWindow() = default;

void GraphSlamWindow::wait_until_closed() {
  constexpr std::chrono::milliseconds kPause(100);
  std::map<std::string, bool> events;
  while (window_->isOpen() && !events["Ctrl+c"]) {
    std::this_thread::sleep_for(kPause);
    window_->forceRepaint();
    observer_.returnEventsStruct(&events, /*reset_keypresses=*/false);
  }
}

}  // namespace psi_slam
