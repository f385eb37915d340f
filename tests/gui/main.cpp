// SPDX-License-Identifier: BSD-3-Clause
// main() of the window's tests. It starts the program again under xvfb-run with software OpenGL, so that the
// tests need no display. The tests named kSmallScreenTests get a small screen with a window manager, as on a
// desktop. Each test needs a process of its own: run them with ctest.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace {

constexpr const char* kOnDisplay = "PSI_SLAM_GUI_TEST_DISPLAY";
constexpr const char* kSmallScreenTests = "--gtest_filter=SmallScreenTest.";

// Starts a window manager in the background, and then the program with its arguments.
constexpr const char* kUnderWindowManager =
    "if command -v openbox >/dev/null; then openbox >/dev/null 2>&1 & "
    "export PSI_SLAM_GUI_TEST_WINDOW_MANAGER=1; fi; exec \"$@\"";

bool runs_on_small_screen(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]).rfind(kSmallScreenTests, 0) == 0) return true;
  return false;
}

bool lists_tests_only(int argc, char** argv) {
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]).rfind("--gtest_list_tests", 0) == 0) return true;
  return false;
}

void start_on_own_display(int argc, char** argv) {
  setenv(kOnDisplay, "1", 1);
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  setenv("GDK_BACKEND", "x11", 1);
  setenv("NO_AT_BRIDGE", "1", 1);
  setenv("GTK_THEME", "Adwaita", 1);
  unsetenv("WAYLAND_DISPLAY");
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  std::vector<std::string> words{"xvfb-run", "-a", "-s"};
  if (runs_on_small_screen(argc, argv))
    words.insert(words.end(), {"-screen 0 1500x950x24", "sh", "-c", kUnderWindowManager, "sh", self});
  else
    words.insert(words.end(), {"-screen 0 2880x1800x24", self});
  words.insert(words.end(), argv + 1, argv + argc);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execvp(pointers[0], pointers.data());  // returns if xvfb-run is missing; then the tests are skipped
  unsetenv(kOnDisplay);
}

}  // namespace

int main(int argc, char** argv) {
  if (!lists_tests_only(argc, argv) && std::getenv(kOnDisplay) == nullptr) start_on_own_display(argc, argv);
  testing::InitGoogleMock(&argc, argv);
  return RUN_ALL_TESTS();
}
