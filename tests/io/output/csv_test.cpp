// Histories: exact numbers, names and units, a kill in mid-row, a full disk.
#include "io/output/csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <limits>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "tests/io/full_disk.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::csv_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<CsvColumn> columns{{"time", "s"}, {"kinetic_energy", "J"}, {"residual"}};

TEST(Csv, HeaderNamesEveryColumnWithItsUnit)
{
  const ScratchFolder folder;
  const HistoryFile history(folder / "history.csv", columns);
  EXPECT_EQ(read_whole(folder / "history.csv"), "time [s],kinetic_energy [J],residual\n");
}

TEST(Csv, NumbersReadBackAsTheSameBits)
{
  const ScratchFolder folder;
  using Limits = std::numeric_limits<Real>;
  const std::vector<Real> values{
      0.1, 1.0 / 3, -0.0, Limits::min(), Limits::denorm_min(), Limits::max(), std::nextafter(1.0, 2.0), Limits::infinity()};
  HistoryFile file(folder / "history.csv", {{"time", "s"}});
  for (const Real value : values)
    file.append(std::array{value});
  const HistoryTable history = read_history(folder / "history.csv");
  const auto read = history["time"].value();
  ASSERT_EQ(read.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(read[i]), std::bit_cast<std::uint64_t>(values[i])) << values[i];
}

TEST(Csv, WhatHasNoValueIsAnEmptyEntry)
{
  const ScratchFolder folder;
  constexpr Real nothing = std::numeric_limits<Real>::quiet_NaN();
  HistoryFile file(folder / "history.csv", columns);
  file.append(std::array{0.5, nothing, nothing});
  file.append(std::array{nothing, 2.0, nothing});
  EXPECT_EQ(read_whole(folder / "history.csv"), "time [s],kinetic_energy [J],residual\n0.5,,\n,2,\n");
  const HistoryTable read = read_history(folder / "history.csv");
  EXPECT_THAT(read["time"].value(), ElementsAre(0.5, testing::IsNan()));
  EXPECT_THAT(read["kinetic_energy"].value(), ElementsAre(testing::IsNan(), 2.0));
}

TEST(Csv, EveryRowIsInTheFileBeforeAppendReturns)
{
  const ScratchFolder folder;
  HistoryFile file(folder / "history.csv", columns);
  for (int i = 0; i < 3; ++i) {
    file.append(std::array{0.5 * i, 2.0, 1e-3});
    EXPECT_EQ(read_history(folder / "history.csv").rows(), static_cast<std::size_t>(i + 1));
  }
}

TEST(Csv, NamesWithCommasAndQuotesSurvive)
{
  const ScratchFolder folder;
  const std::vector<CsvColumn> odd{{"time", "s"}, {"toe, \"left\"", "m"}, {"a [b] c", "-"}};
  HistoryFile(folder / "history.csv", odd).append(std::array{0.0, 1.0, 2.0});
  const HistoryTable read = read_history(folder / "history.csv");
  EXPECT_EQ(read.columns, odd);
  EXPECT_THAT(read["toe, \"left\""].value(), ElementsAre(1.0));
  EXPECT_FALSE(read["toe"].has_value());
}

TEST(Csv, ResumeDropsLaterRowsAndARowCutShort)
{
  const ScratchFolder folder;
  {
    HistoryFile file(folder / "history.csv", columns);
    for (const Real t : {0.0, 0.1, 0.2, 0.3})
      file.append(std::array{t, 1.0 / 3, 0.0});
  }
  std::ofstream(folder / "history.csv", std::ios::app) << "0.4,0.33";
  auto resumed = HistoryFile::resume(folder / "history.csv", columns, 0.2);
  resumed.append(std::array{0.25, 7.0, 0.0});
  const HistoryTable read = read_history(folder / "history.csv");
  EXPECT_THAT(read["time"].value(), ElementsAre(0.0, 0.1, 0.2, 0.25));
  EXPECT_THAT(read["kinetic_energy"].value(), ElementsAre(1.0 / 3, 1.0 / 3, 1.0 / 3, 7.0));
}

TEST(Csv, TextsThatASpreadsheetWouldRunAreWrittenAsTexts)
{
  EXPECT_EQ(csv_cell("=cmd|' /C calc'!A0"), "'=cmd|' /C calc'!A0");
  EXPECT_EQ(csv_cell("=HYPERLINK(\"a\",\"b\")"), "\"'=HYPERLINK(\"\"a\"\",\"\"b\"\")\"");
  EXPECT_EQ(csv_cell("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(csv_cell("-5 m"), "'-5 m");
  EXPECT_EQ(csv_cell("+x"), "'+x");
  EXPECT_EQ(csv_cell("'=x"), "''=x");
  for (const char* plain : {"-5", "-1.5e-3", "+2", "-inf", "toe", "a=b", "'quoted'", ""})
    EXPECT_EQ(csv_cell(plain), plain);
  const ScratchFolder folder;
  const std::vector<CsvColumn> named{{"time", "s"}, {"=1+1", "m"}, {"'@x"}, {"-5 m"}, {"'plain"}};
  HistoryFile(folder / "history.csv", named).append(std::array{0.0, 1.0, 2.0, 3.0, 4.0});
  EXPECT_EQ(read_whole(folder / "history.csv"), "time [s],'=1+1 [m],''@x,'-5 m,'plain\n0,1,2,3,4\n");
  EXPECT_EQ(read_history(folder / "history.csv").columns, named);
  HistoryFile::resume(folder / "history.csv", named, 0).append(std::array{1.0, 1.0, 2.0, 3.0, 4.0});
  EXPECT_EQ(read_history(folder / "history.csv").rows(), 2u);
}

TEST(Csv, ResumeRefusesOtherColumns)
{
  const ScratchFolder folder;
  HistoryFile(folder / "history.csv", columns).append(std::array{0.0, 1.0, 0.0});
  EXPECT_THROW(HistoryFile::resume(folder / "history.csv", {{"time", "s"}}, 1.0), EnvironmentError);
  EXPECT_EQ(read_history(folder / "history.csv").rows(), 1u);
}

TEST(Csv, RowOfTheWrongLengthIsRefused)
{
  const ScratchFolder folder;
  HistoryFile file(folder / "history.csv", columns);
  EXPECT_THROW(file.append(std::array{1.0, 2.0}), std::invalid_argument);
}

TEST(Csv, DamagedRowIsNamedByItsLine)
{
  const ScratchFolder folder;
  const auto message = [&](const std::string& text) -> std::string {
    std::ofstream(folder / "bad.csv") << text;
    try {
      read_history(folder / "bad.csv");
    } catch (const EnvironmentError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message("time [s],a\n0,1\n1,x2\n"), HasSubstr("bad.csv:3: \"x2\" is not a number"));
  EXPECT_THAT(message("time [s],a\n0\n"), HasSubstr("bad.csv:2: 1 values for 2 columns"));
  EXPECT_THAT(message(""), HasSubstr("no header"));
}

TEST(Csv, FullDiskIsAnEnvironmentErrorThatNamesTheFile)
{
  const ScratchFolder folder;
  HistoryFile file(folder / "history.csv", {{"time", "s"}});
  const FullDisk full(100);
  std::string message;
  for (int i = 0; i < 100 && message.empty(); ++i) {
    try {
      file.append(std::array{1.0 / 3});
    } catch (const EnvironmentError& error) {
      message = error.what();
    }
  }
  EXPECT_THAT(message, HasSubstr((folder / "history.csv").string()));
}

TEST(Csv, FolderThatCannotBeMadeIsAnEnvironmentError)
{
  const ScratchFolder folder;
  std::ofstream(folder / "file") << "not a folder";
  EXPECT_THROW(HistoryFile(folder / "file/history.csv", columns), EnvironmentError);
}

}  // namespace
}  // namespace talus::csv_test
