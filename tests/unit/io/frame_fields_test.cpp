// The tables of fields and the page that explains them to users list the same fields with the same words.

#include "io/results/frame_fields.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

namespace gcpdda::frame_fields_test {
namespace {

/// Rows of the table of the guide with this head.
std::vector<std::string> rows_of_guide(const std::string &head) {
  std::ifstream guide(GCPDDA_SOURCE_DIR "/run/guide/09_results_and_pictures.md");
  std::vector<std::string> rows;
  std::string line;
  while (std::getline(guide, line) && line != head) {
  }
  std::getline(guide, line); // the rule below the head
  while (std::getline(guide, line) && line.starts_with("|")) {
    rows.push_back(line);
  }
  return rows;
}

template <class Fields> std::vector<std::string> rows_of(const Fields &fields) {
  std::vector<std::string> rows;
  for_each_field(fields, [&](const auto &field) {
    rows.push_back(std::string("| `") + field.name + "` | " + field.meaning + " |");
  });
  return rows;
}

TEST(FrameFields, AreThoseOfTheGuide) {
  EXPECT_EQ(rows_of_guide("| field of a frame | meaning |"), rows_of(block_fields));
  EXPECT_EQ(rows_of_guide("| field of a contact | meaning |"), rows_of(contact_fields));
}

} // namespace
} // namespace gcpdda::frame_fields_test
