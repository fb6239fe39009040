// JSON text of strings that come from elsewhere, such as the names of folders.

#include "io/results/json.hpp"

#include <gtest/gtest.h>

#include <string>

namespace gcpdda::json_test {
namespace {

TEST(Json, LeavesUtf8AsItIs) {
  const std::string text = "a\u00e4\u20ac\U0001f600\u07ff\ud7fb\uffff";
  EXPECT_EQ(json(text), '"' + text + '"');
  EXPECT_EQ(json(std::string("a\"\\\n")), "\"a\\\"\\\\\\u000a\"");
}

// One sign for each byte that is part of no character: JSON text is UTF-8, the names of files need not be.
TEST(Json, ReplacesBytesThatAreNoUtf8) {
  const std::string sign = "\\ufffd";
  EXPECT_EQ(json(std::string("bad\xff\xfe!")), "\"bad" + sign + sign + "!\"");
  EXPECT_EQ(json(std::string("M\xfcller")), "\"M" + sign + "ller\"") << "Latin-1";
  EXPECT_EQ(json(std::string("\xe2\x82")), '"' + sign + sign + '"') << "the end is missing";
  EXPECT_EQ(json(std::string("\x80")), '"' + sign + '"') << "the begin is missing";
  EXPECT_EQ(json(std::string("\xc0\xaf")), '"' + sign + sign + '"') << "longer than it may be";
  EXPECT_EQ(json(std::string("\xe0\x80\xaf")), '"' + sign + sign + sign + '"') << "longer than it may be";
  EXPECT_EQ(json(std::string("\xed\xa0\x80")), '"' + sign + sign + sign + '"') << "half of a pair of UTF-16";
  EXPECT_EQ(json(std::string("\xf4\x90\x80\x80")), '"' + sign + sign + sign + sign + '"') << "above 10FFFF";
}

} // namespace
} // namespace gcpdda::json_test
