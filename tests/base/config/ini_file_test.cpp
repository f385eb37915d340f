// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/ini_file.h"

#include <gmock/gmock.h>

#include "base/atomic_file.h"
#include "sample_settings.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

std::string value_of(const std::string& line) {
  const IniFile file = parse_ini("[a]\n" + line + "\n", "my.ini");
  return file.values.size() == 1 ? file.values[0].text : "(not one value)";
}

std::string refusal(const std::string& text) {
  return sentence([&] { parse_ini(text, "my.ini"); });
}

TEST(IniFile, keeps_section_key_value_and_line) {
  const IniFile file =
      parse_ini("\n; settings\n[ front_end ]  ; title\n  window_m=0.15 \n\n[log]\nlabel = x y", "my.ini");
  ASSERT_EQ(file.sections.size(), 2u);
  EXPECT_EQ(file.sections[0].name, "front_end");
  EXPECT_EQ(file.sections[1].where, "my.ini:6");
  ASSERT_EQ(file.values.size(), 2u);
  EXPECT_EQ(file.values[0].section, "front_end");
  EXPECT_EQ(file.values[0].key, "window_m");
  EXPECT_EQ(file.values[0].text, "0.15");
  EXPECT_EQ(file.values[0].where, "my.ini:4");
  EXPECT_EQ(file.values[1].text, "x y");
}

TEST(IniFile, reads_what_windows_editors_write) {
  const IniFile file = parse_ini("\xEF\xBB\xBF[a]\r\nk = v\r\n\r\n", "my.ini");
  ASSERT_EQ(file.values.size(), 1u);
  EXPECT_EQ(file.values[0].text, "v");
}

TEST(IniFile, ignores_comments) {
  EXPECT_EQ(value_of("k = 5 ; five"), "5");
  EXPECT_EQ(value_of("k = 5; five"), "5");
  EXPECT_EQ(value_of("k = 5 # five"), "5");
  EXPECT_EQ(value_of("k = 5 // five"), "5");
  EXPECT_EQ(value_of("k = // nothing"), "");
  EXPECT_EQ(value_of("k ="), "");
  EXPECT_EQ(value_of("// c = 1\n # d = 2\n\t; e = 3\nk = http://host/a#b"), "http://host/a#b");
}

TEST(IniFile, quotes_keep_all_characters) {
  EXPECT_EQ(value_of(R"(k = " a ; b # c // d " ; comment)"), " a ; b # c // d ");
  EXPECT_EQ(value_of(R"(k = "say \"hi\" \\ there")"), R"(say "hi" \ there)");
  EXPECT_EQ(value_of(R"(k = "")"), "");
  EXPECT_EQ(refusal("[a]\nk = \"open"), "my.ini:2: the closing quote is missing");
  EXPECT_EQ(refusal("[a]\nk = \"open\\"), R"(my.ini:2: a backslash in quotes is written \\, and a quote \")");
  EXPECT_THAT(refusal(R"([a]
k = "C:\maps")"),
              HasSubstr("a backslash in quotes"));
  EXPECT_EQ(refusal("[a]\nk = \"x\" y"), "my.ini:2: expected the end of the line after the closing quote");
}

TEST(IniFile, every_text_of_one_line_can_be_written_as_a_value) {
  for (const std::string text : {"", "x", "a b", " a ", "a;b", "a # b", "a#b", "#a", "//a", "a //b", "\"",
                                 "\\", "\"a\"", "C:\\maps\\", "a\\\"b", "\t", "ä"}) {
    EXPECT_EQ(value_of("k = " + ini_value_text(text) + " ; comment"), text) << ini_value_text(text);
  }
  EXPECT_EQ(ini_value_text("0.5"), "0.5");
}

TEST(IniFile, rejects_malformed_lines) {
  EXPECT_EQ(refusal("[a]\n\nwindow 5\n"), "my.ini:3: expected key = value or [section], not window 5");
  EXPECT_EQ(refusal("[a]\n = 5"), "my.ini:2: expected key = value or [section], not = 5");
  EXPECT_EQ(refusal("[a\n"), "my.ini:1: expected [section], not [a");
  EXPECT_EQ(refusal("[]\n"), "my.ini:1: expected [section], not []");
  EXPECT_EQ(refusal("[a] b\n"), "my.ini:1: expected [section], not [a] b");
  EXPECT_EQ(refusal("k = 5\n"), "my.ini:1: \"k\" precedes the first [section]");
}

TEST(IniFile, quotes_a_short_printable_part_of_a_malformed_line) {
  const std::string endless(1'000'000, 'a');
  const std::string part = std::string(80, 'a') + "...";
  EXPECT_EQ(refusal(endless), "my.ini:1: expected key = value or [section], not " + part);
  EXPECT_EQ(refusal('[' + endless), "my.ini:1: expected [section], not [" + std::string(79, 'a') + "...");
  EXPECT_EQ(refusal(endless + " = 1"), "my.ini:1: \"" + part + "\" precedes the first [section]");
  EXPECT_EQ(refusal({"[a]\nb\0c\x1b", 8}), "my.ini:2: expected key = value or [section], not b?c?");
}

TEST(IniFile, rejects_large_files) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "large.ini";
  write_text_atomically(path, std::string(17'000'000, ';'));
  const std::string why = ": it has more than 16 MiB, expected a file of settings. Name another file";
  EXPECT_EQ(sentence([&] { read_ini(path); }), "cannot read " + path.string() + why);
  EXPECT_EQ(sentence([&] { read_ini("/dev/zero"); }), "cannot read /dev/zero" + why);
}

TEST(IniFile, rejects_a_key_given_twice) {
  EXPECT_EQ(refusal("[a]\nk = 1\n[b]\nk = 2\n[a]\nk = 3\n"),
            "my.ini:6: \"k\" in [a] is given twice, first in line 2; keep one");
  EXPECT_EQ(parse_ini("[a]\nk = 1\nK = 2\n", "my.ini").values.size(), 2u) << "names are case-sensitive";
}

class IncludeTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    const std::filesystem::path path = folder_.path() / name;
    std::filesystem::create_directories(path.parent_path());
    write_text_atomically(path, text);
    return path;
  }
  std::string in_folder(const std::string& name) { return (folder_.path() / name).string(); }

  TemporaryFolder folder_;
};

TEST_F(IncludeTest, an_included_file_comes_before_the_values_that_override_it) {
  write("usual.ini", "[a]\nk = 1\nl = 2\n");
  write("logs/site.ini", "include = ../usual.ini\n[a]\nk = 3\n");
  const IniFile file = read_ini(write("logs/my.ini", "include = \"site.ini\" ; the house\n[a]\nk = 4\n"));
  ASSERT_EQ(file.values.size(), 4u);
  EXPECT_EQ(file.values[0].where, in_folder("usual.ini") + ":2");
  EXPECT_EQ(file.values[1].text, "2");
  EXPECT_EQ(file.values[2].text, "3");
  EXPECT_EQ(file.values[3].text, "4");
}

TEST_F(IncludeTest, may_include_one_file_twice_but_not_itself) {
  write("usual.ini", "[a]\nk = 1\n");
  EXPECT_EQ(read_ini(write("my.ini", "include = usual.ini\ninclude = ./usual.ini\n")).values.size(), 2u);
  write("a.ini", "include = b.ini\n");
  write("b.ini", "; back\ninclude = sub/../c.ini\n");
  const auto c = write("c.ini", "include = b.ini\n");
  EXPECT_EQ(sentence([&] { read_ini(folder_.path() / "a.ini"); }),
            c.string() + ":1: a file cannot include itself: " + in_folder("b.ini") + " -> " +
                in_folder("c.ini") + " -> " + in_folder("b.ini"));
  const auto self = write("self.ini", "include = self.ini\n");
  EXPECT_EQ(sentence([&] { read_ini(self); }),
            self.string() + ":1: a file cannot include itself: " + self.string() + " -> " + self.string());
}

TEST_F(IncludeTest, recognises_a_file_under_another_name) {
  std::filesystem::create_directory_symlink(".", folder_.path() / "again");
  const auto path = write("my.ini", "include = again/my.ini\n");
  EXPECT_EQ(sentence([&] { read_ini(path); }), path.string() + ":1: a file cannot include itself: " +
                                                   path.string() + " -> " + in_folder("again/my.ini"));
}

TEST_F(IncludeTest, names_an_unreadable_file) {
  const auto path = write("my.ini", "; settings\ninclude = absent.ini\n");
  EXPECT_EQ(sentence([&] { read_ini(path); }), path.string() + ":2: cannot read the included file " +
                                                   in_folder("absent.ini") + ": No such file or directory");
  EXPECT_EQ(sentence([&] { read_ini(folder_.path() / "none.ini"); }),
            "cannot read " + in_folder("none.ini") + ": No such file or directory");
  EXPECT_EQ(sentence([&] { read_ini(folder_.path()); }),
            "cannot read " + folder_.path().string() + ": it is a folder");
  EXPECT_EQ(refusal("include =\n"), "my.ini:1: include needs the name of a file");
  EXPECT_EQ(refusal("[a]\ninclude = usual.ini\n"), "my.ini:2: include must precede the first section");
}

}  // namespace
}  // namespace psi_slam
