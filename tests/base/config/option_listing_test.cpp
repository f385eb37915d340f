// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/settings_text.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>

#include "sample_settings.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

SampleSettings random_settings(std::mt19937_64& random) {
  const auto draw = [&](double min, double max) {
    return std::uniform_real_distribution<double>(min, max)(random);
  };
  SampleSettings settings;
  settings.window_x_m = draw(0.01, 20);
  settings.window_theta_rad = draw(1e-6, M_PI);
  settings.matcher = random() % 2 == 0 ? SampleMatcher::kCsm : SampleMatcher::kGa;
  settings.close_loops = random() % 2 == 0;
  settings.passes = static_cast<int>(random() % 11) - 5;
  settings.nodes = 1 + random() % 1000;
  settings.seed = random();
  if (random() % 2 == 0) settings.max_range_m = draw(0.1, 100);
  settings.field_of_view_rad.reset();
  if (random() % 2 == 0) settings.field_of_view_rad = draw(0.1, 2 * M_PI);
  settings.label.clear();
  for (std::size_t length = random() % 8; length > 0; --length)
    settings.label += " a;#/\"\\=[]"[random() % 10];
  settings.psi_1 = draw(-1, 1) * std::pow(10, draw(-300, 300));
  return settings;
}

std::uint64_t bits(double value) {
  std::uint64_t result = 0;
  std::memcpy(&result, &value, sizeof result);
  return result;
}

void expect_same_bits(const SampleSettings& a, const SampleSettings& b) {
  EXPECT_EQ(bits(a.window_x_m), bits(b.window_x_m));
  EXPECT_EQ(bits(a.window_theta_rad), bits(b.window_theta_rad));
  EXPECT_EQ(a.matcher, b.matcher);
  EXPECT_EQ(a.close_loops, b.close_loops);
  EXPECT_EQ(a.passes, b.passes);
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.max_range_m, b.max_range_m);
  EXPECT_EQ(a.field_of_view_rad, b.field_of_view_rad);
  EXPECT_EQ(a.label, b.label);
  EXPECT_EQ(bits(a.psi_1), bits(b.psi_1));
}

TEST(OptionListing, a_dump_that_is_loaded_restores_every_bit) {
  std::mt19937_64 random(3);
  SampleSettings saved;
  SampleSettings loaded;
  const OptionTable saved_table = describe(saved);
  OptionTable loaded_table = describe(loaded);
  for (int i = 0; i < 500; ++i) {
    saved = i == 0 ? SampleSettings() : random_settings(random);
    const std::string text = dump(saved_table);
    apply(parse_ini(text, "dump.ini"), loaded_table);
    expect_same_bits(saved, loaded);
    ASSERT_EQ(dump(loaded_table), text);
  }
}

TEST(OptionListing, a_dump_describes_each_value) {
  SampleSettings settings;
  const OptionTable table = describe(settings);
  settings.window_x_m = 2;
  const std::string text = dump(table);
  EXPECT_THAT(text, HasSubstr("; Matching each scan with the active local map\n[front_end]\n"));
  EXPECT_THAT(text, HasSubstr("\n; half-width of the search window\n"
                              "; m, between 0.01 and 20; default 0.15\n"
                              "window_x_m = 2\n"));
  EXPECT_THAT(text, HasSubstr("; deg, above 0 and at most 180; default 4.010704565915763"));
  EXPECT_THAT(text, HasSubstr("; one of csm, ga; default csm\nmatcher = csm\n"));
  EXPECT_THAT(text, HasSubstr("; true or false; default true\nclose_loops = true\n"));
  EXPECT_THAT(text, HasSubstr("; whole number, 0 or more; default 1\nseed = 1\n"));
  EXPECT_THAT(text, HasSubstr("; m, above 0; or auto; default auto\nmax_range_m = auto\n"));
}

TEST(OptionListing, does_not_dump_invalid_values) {
  SampleSettings settings;
  const OptionTable table = describe(settings);
  settings.window_x_m = std::nan("");
  EXPECT_THROW(dump(table), std::logic_error);
  settings.window_x_m = 1;
  settings.label = "two\nlines";
  EXPECT_THROW(dump(table), std::logic_error);
}

TEST(OptionListing, the_reference_and_the_help_name_every_option) {
  SampleSettings settings;
  const OptionTable table = describe(settings);
  const std::string page = markdown_reference(table);
  const std::string help = help_text(table);
  for (const OptionSection& section : table.sections()) {
    EXPECT_THAT(page, HasSubstr("## `[" + section.name + "]` " + section.title + '\n'));
    for (const Option& option : section.options) {
      EXPECT_THAT(page, HasSubstr("| `" + option.key + "` | "));
      EXPECT_THAT(help, HasSubstr(option.name() + "\n      " + option.help));
    }
  }
  EXPECT_THAT(
      page,
      HasSubstr("| `window_x_m` | m, between 0.01 and 20 | `0.15` | half-width of the search window |"));
  EXPECT_THAT(page, HasSubstr(R"(global passes \| at the end)")) << "an unescaped bar would end the cell";
}

}  // namespace
}  // namespace psi_slam
