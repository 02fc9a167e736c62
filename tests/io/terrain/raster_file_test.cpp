// Rasters, written and read by GDAL and by hand.
#include "io/terrain/raster_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cmath>
#include <limits>
#include <mutex>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"
#include "io/system/http_server.hpp"
#include "io/terrain/map_crs.hpp"
#include "io/terrain/polygon_file.hpp"
#include "tests/io/full_disk.hpp"
#include "tests/io/scratch_folder.hpp"

namespace talus::raster_file_test {
namespace {

using testing::HasSubstr;

constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();

/// Three columns, two rows; values are exact in float32.
Raster sample()
{
  Raster raster;
  raster.columns = 3;
  raster.rows = 2;
  raster.west = 512000;
  raster.south = 5180000;
  raster.dx = raster.dy = 2.5;
  raster.values = {1, 2.5, nan, 4, -5.25, 600};
  raster.crs = "EPSG:32633";
  raster.unit = "m";
  return raster;
}

void expect_equal(const Raster& read, const Raster& written)
{
  EXPECT_EQ(read.columns, written.columns);
  EXPECT_EQ(read.rows, written.rows);
  EXPECT_EQ(read.west, written.west);
  EXPECT_EQ(read.south, written.south);
  EXPECT_EQ(read.dx, written.dx);
  EXPECT_EQ(read.dy, written.dy);
  ASSERT_EQ(read.values.size(), written.values.size());
  for (std::size_t i = 0; i < read.values.size(); ++i)
    EXPECT_TRUE(read.values[i] == written.values[i] || (std::isnan(read.values[i]) && std::isnan(written.values[i]))) << i;
  EXPECT_EQ(read.crs, written.crs);
}

template <class F>
std::string complaint_of(F&& f)
{
  try {
    f();
  } catch (const EnvironmentError& error) {
    return error.what();
  }
  return "nothing was wrong";
}

std::vector<std::string> names(const ScratchFolder& folder)
{
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    found.push_back(entry.path().filename().string());
  std::sort(found.begin(), found.end());
  return found;
}

TEST(RasterFile, GeotiffReadsBackWithPlaceUnitAndHoles)
{
  const ScratchFolder folder;
  Raster raster = sample();
  raster.dy = 5;  // cells need not be squares
  write_raster(folder / "maps/ground.tif", raster);
  const Raster read = read_raster(folder / "maps/ground.tif");
  expect_equal(read, raster);
  EXPECT_EQ(read.unit, "m");
}

TEST(RasterFile, GeotiffWithoutCoordinateSystemSaysNothingOfOne)
{
  const ScratchFolder folder;
  Raster raster = sample();
  raster.crs.clear();
  write_raster(folder / "local.tif", raster);
  expect_equal(read_raster(folder / "local.tif"), raster);
  EXPECT_THAT(names(folder), testing::ElementsAre("local.tif"));
}

TEST(RasterFile, AsciiGridReadsBackAndHasItsCoordinateSystemBeside)
{
  const ScratchFolder folder;
  write_raster(folder / "ground.asc", sample());
  EXPECT_THAT(names(folder), testing::ElementsAre("ground.asc", "ground.prj"));
  expect_equal(read_raster(folder / "ground.asc"), sample());
}

TEST(RasterFile, AsciiGridOfOthersIsRead)
{
  const ScratchFolder folder;
  write_whole(folder / "other.asc", "NCOLS 2\nNROWS 2\nXLLCENTER 10\nYLLCENTER 20\nCELLSIZE 4\nNODATA_VALUE -1\n1 2\n3 -1\n");
  const Raster read = read_raster(folder / "other.asc");
  EXPECT_EQ(read.west, 8);
  EXPECT_EQ(read.south, 18);
  EXPECT_EQ(read.at(0, 0), 3);
  EXPECT_TRUE(std::isnan(read.at(1, 0)));
  EXPECT_EQ(read.at(1, 1), 2);
}

TEST(RasterFile, TableHasCentresAndNoHoles)
{
  const ScratchFolder folder;
  write_raster(folder / "thickness.csv", sample());
  EXPECT_EQ(read_whole(folder / "thickness.csv"),
            "x [m],y [m],value [m]\n512001.25,5180001.25,1\n512003.75,5180001.25,2.5\n512001.25,5180003.75,4\n"
            "512003.75,5180003.75,-5.25\n512006.25,5180003.75,600\n");
}

TEST(RasterFile, AsciiGridWantsSquares)
{
  const ScratchFolder folder;
  Raster raster = sample();
  raster.dy = 3;
  EXPECT_THAT(complaint_of([&] { write_raster(folder / "g.asc", raster); }), testing::AllOf(HasSubstr("g.asc"), HasSubstr("no squares")));
}

TEST(RasterFile, UnknownExtensionIsRefused)
{
  const ScratchFolder folder;
  EXPECT_THAT(complaint_of([&] { write_raster(folder / "g.jpg", sample()); }), HasSubstr("maps are .tif, .asc or .csv, not '.jpg'"));
}

TEST(RasterFile, FullDiskLeavesTheOldFile)
{
  const ScratchFolder folder;
  write_raster(folder / "g.tif", sample());
  Raster large = sample();
  large.columns = 300;
  large.rows = 200;
  large.values.assign(60000, 0);
  for (std::size_t i = 0; i < large.values.size(); ++i)
    large.values[i] = std::sin(static_cast<Real>(i * i));  // not to be compressed
  {
    const FullDisk full(20000);
    EXPECT_THAT(complaint_of([&] { write_raster(folder / "g.tif", large); }), HasSubstr("g.tif"));
  }
  expect_equal(read_raster(folder / "g.tif"), sample());
  EXPECT_THAT(names(folder), testing::ElementsAre("g.tif"));
}

TEST(RasterFile, WhatIsNoRasterIsNamed)
{
  const ScratchFolder folder;
  write_whole(folder / "text.tif", "no raster at all");
  for (const char* name : {"text.tif", "missing.tif", "."})
    EXPECT_THAT(complaint_of([&] { read_raster(folder / name); }), HasSubstr((folder / name).string()));
  EXPECT_THAT(complaint_of([&] { read_raster(folder / "missing.tif"); }), HasSubstr("there is no such file"));
}

TEST(RasterFile, CutShortIsNoticed)
{
  const ScratchFolder folder;
  write_raster(folder / "g.asc", sample());
  const std::string text = read_whole(folder / "g.asc");
  write_whole(folder / "short.asc", text.substr(0, text.size() - 8));
  EXPECT_THAT(complaint_of([&] { read_raster(folder / "short.asc"); }), HasSubstr("short.asc"));
}

TEST(RasterFile, TurnedRasterIsRefusedWithTheCommandThatTurnsIt)
{
  const ScratchFolder folder;
  write_whole(folder / "turned.bil", std::string(4, '\1'));
  write_whole(folder / "turned.hdr", "NROWS 2\nNCOLS 2\nNBANDS 1\nNBITS 8\nLAYOUT BIL\n");
  write_whole(folder / "turned.blw", "0.8\n0.6\n0.6\n-0.8\n0\n0\n");
  EXPECT_THAT(complaint_of([&] { read_raster(folder / "turned.bil"); }),
              testing::AllOf(HasSubstr("turned by 36.87 degrees"), HasSubstr("gdalwarp")));
}

/// A server on this machine that records the requests and sends nothing back.
class Ears {
 public:
  Ears()
      : server_(0, [this](const std::string& path) -> std::optional<HttpAnswer> {
          const std::scoped_lock lock(heard_of_);
          paths_.push_back(path);
          return HttpAnswer{"text/plain", std::make_shared<const std::string>("EPSG:32633")};
        })
  {}
  std::string url(const std::string& path) const { return "http://127.0.0.1:" + std::to_string(server_.port()) + path; }
  std::vector<std::string> heard() const
  {
    const std::scoped_lock lock(heard_of_);
    return paths_;
  }

 private:
  mutable std::mutex heard_of_;
  std::vector<std::string> paths_;
  HttpServer server_;
};

TEST(RasterFile, NoFileIsAWayToTheNetworkOrToOtherFiles)
{
  const ScratchFolder folder;
  const Ears ears;
  write_raster(folder / "g.tif", sample());
  const auto vrt = [&](const std::string& source) {
    return "<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\"><GeoTransform>0, 1, 0, 2, 0, -1</GeoTransform><VRTRasterBand "
           "dataType=\"Float32\" band=\"1\">" +
           source + "</VRTRasterBand></VRTDataset>";
  };
  const auto simple = [&](const std::string& name) {
    return vrt("<SimpleSource><SourceFilename relativeToVRT=\"0\">" + name + "</SourceFilename><SourceBand>1</SourceBand></SimpleSource>");
  };
  for (const auto& [name, text] :
       {std::pair<std::string, std::string>{"other.vrt", simple((folder / "g.tif").string())},
        {"network.vrt", simple("/vsicurl/" + ears.url("/y.tif"))},
        {"network.tif", simple("/vsicurl/" + ears.url("/z.tif"))},
        {"wms.xml", "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>" + ears.url("/${z}/${x}/${y}.png") +
                        "</ServerUrl></Service><DataWindow><UpperLeftX>0</UpperLeftX><UpperLeftY>1</UpperLeftY><LowerRightX>1</LowerRightX>"
                        "<LowerRightY>0</LowerRightY><SizeX>256</SizeX><SizeY>256</SizeY><TileLevel>0</TileLevel></DataWindow>"
                        "<BandsCount>1</BandsCount></GDAL_WMS>"},
        {"raw.vrt",
         "<VRTDataset rasterXSize=\"3\" rasterYSize=\"2\"><GeoTransform>0, 1, 0, 2, 0, -1</GeoTransform><VRTRasterBand "
         "dataType=\"Byte\" band=\"1\" subClass=\"VRTRawRasterBand\"><SourceFilename>/etc/passwd</SourceFilename>"
         "</VRTRasterBand></VRTDataset>"}}) {
    write_whole(folder / name, text);
    EXPECT_THAT(complaint_of([&] { read_raster(folder / name); }),
                testing::AllOf(HasSubstr(name), HasSubstr("is no raster of a format that is read")));
  }
  for (const std::string& name : {"/vsicurl/" + ears.url("/a.tif"), "/vsizip/" + (folder / "g.zip").string()})
    EXPECT_THAT(complaint_of([&] { read_raster(name); }), HasSubstr("there is no such file"));
  EXPECT_FALSE(crs_facts(ears.url("/crs")));
  write_whole(folder / "crs.txt", "EPSG:32633");
  EXPECT_FALSE(crs_facts((folder / "crs.txt").string())) << "a file is no text";
  // Of GeoJSON a coordinate system may be an address.
  write_whole(folder / "o.geojson", "{\"type\": \"FeatureCollection\", \"crs\": {\"type\": \"link\", \"properties\": {\"href\": \"" +
                                        ears.url("/link") + "\", \"url\": \"" + ears.url("/link") +
                                        "\"}}, \"features\": [{\"type\": \"Feature\", \"properties\": {}, \"geometry\": {\"type\": "
                                        "\"Polygon\", \"coordinates\": [[[0, 0], [9, 0], [9, 9], [0, 0]]]}}]}");
  try {
    read_polygons(folder / "o.geojson");
  } catch (const EnvironmentError&) {
  }
  EXPECT_THAT(ears.heard(), testing::IsEmpty());
}

TEST(RasterFile, APipeBesideARasterDoesNotKeepItWaiting)
{
  const ScratchFolder folder;
  write_raster(folder / "ground.asc", sample());
  std::filesystem::remove(folder / "ground.prj");
  ASSERT_EQ(::mkfifo((folder / "ground.prj").c_str(), 0600), 0);
  EXPECT_THAT(complaint_of([&] { read_raster(folder / "ground.asc"); }), HasSubstr("ground.prj, which belongs to it by its name"));
}

TEST(RasterFile, MoreCellsThanAFileCanHoldAreRefused)
{
  const ScratchFolder folder;
  write_whole(folder / "g.asc", "ncols 14000\nnrows 14000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3\n");
  EXPECT_THAT(complaint_of([&] { read_raster(folder / "g.asc"); }), HasSubstr("g.asc: 196000000 cells cannot be in"));
}

TEST(MapCrs, KnowsUnitsAndDegrees)
{
  const auto utm = crs_facts("EPSG:32633"), degrees = crs_facts("EPSG:4326"), feet = crs_facts("EPSG:2263");
  ASSERT_TRUE(utm && degrees && feet);
  EXPECT_EQ(utm->name, "WGS 84 / UTM zone 33N");
  EXPECT_EQ(utm->code, "EPSG:32633");
  EXPECT_EQ(utm->metres, 1);
  EXPECT_FALSE(utm->geographic);
  EXPECT_TRUE(degrees->geographic);
  EXPECT_NEAR(feet->metres, 0.3048006096, 1e-9);  // US survey foot: 1200/3937 m
  EXPECT_FALSE(crs_facts("no such system"));
}

TEST(MapCrs, ComparesWhatIsSaidOfThePlan)
{
  EXPECT_TRUE(same_plan("EPSG:32633", "EPSG:32633"));
  EXPECT_TRUE(same_plan("EPSG:25833+5783", "EPSG:25833"));  // with heights of its own
  EXPECT_FALSE(same_plan("EPSG:32633", "EPSG:32632"));
}

TEST(MapCrs, NamesTheZoneAndMovesPlaces)
{
  EXPECT_EQ(utm_zone_of("EPSG:4326", {15.2, 46.8}), "EPSG:32633");
  EXPECT_EQ(utm_zone_of("EPSG:4326", {-70.5, -33}), "EPSG:32719");
  const auto moved = to_crs("EPSG:4326", "EPSG:32633", {{15, 0}});  // on the middle of zone 33 and on the equator
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_NEAR(moved[0][0], 500000, 1e-3);
  EXPECT_NEAR(moved[0][1], 0, 1e-3);
}

}  // namespace
}  // namespace talus::raster_file_test
