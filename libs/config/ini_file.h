// SPDX-License-Identifier: BSD-3-Clause
// Reads settings files:
//
//     include = usual.ini       ; before the first section: that file's values, which this one may override
//     [front_end]
//     window_m = 0.15           // a comment
//     label = "a ; b \"c\" \\"  # quotes keep everything; \" and \\ stand for " and \ within
//
// Comments begin with ';' anywhere, or with '#' or '//' at the start of a line, of a value or after a space.
// Names are case-sensitive. A section may be continued later in the file, but a key given twice in one file
// is an error. UTF-8 with or without byte order mark; lines end in LF or CRLF.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace psi_slam {

/// A section's heading in a file.
struct IniSection {
  std::string name;
  std::string where;  ///< "my.ini:12"
};

/// A value in a file.
struct IniValue {
  std::string section;
  std::string key;
  std::string text;   ///< without quotes
  std::string where;  ///< "my.ini:12"
};

/// In the order in which they take effect: those of an included file before those of the file that includes
/// it.
struct IniFile {
  std::vector<IniSection> sections;
  std::vector<IniValue> values;
};

/// Throws UserError with file and line for a line that means nothing, a key given twice, an included file
/// that cannot be read or includes itself; and with the file's name when `path` itself cannot be read.
/// Included names are relative to the folder of the file that includes them.
IniFile read_ini(const std::filesystem::path& path);

/// The same for a text in memory, as if it stood in a file called `path`.
IniFile parse_ini(std::string_view text, const std::filesystem::path& path);

/// `text` so that it can stand behind "key = ": in quotes if it needs them. Line breaks cannot be written.
std::string ini_value_text(const std::string& text);

}  // namespace psi_slam
