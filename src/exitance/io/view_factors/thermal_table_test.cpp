#include "exitance/io/view_factors/thermal_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

SparseFactors two_spheres() {
    SparseFactors out;
    out.areas = {1, 4}, out.emittances = {0.8, 0.6};
    out.columns = {1, 0, 1}, out.values = {1, 0.25, 0.75}, out.starts = {0, 1, 3};
    return out;
}

Result<std::vector<ThermalSurface>> read(const std::string& text) {
    const TemporaryFolder folder;
    std::ofstream(folder / "t.csv") << text;
    return read_thermal_table(folder / "t.csv", two_spheres());
}

TEST(ThermalTable, LaterRowsReplaceEarlierOnesAndEmptyFieldsKeep) {
    const auto surfaces = read("heat,surface,temperature,emissivity\n,0,300,\n5,2,,\n,1,400,0.5\n");
    ASSERT_TRUE(surfaces) << surfaces.error().message;
    EXPECT_EQ((*surfaces)[0].temperature, 400);
    EXPECT_EQ((*surfaces)[0].emissivity, 0.5);
    EXPECT_FALSE((*surfaces)[1].temperature);
    EXPECT_EQ((*surfaces)[1].heat, 5);
    EXPECT_EQ((*surfaces)[1].emissivity, 0.6);
}

TEST(ThermalTable, WrongColumnsRowsAndValuesAreErrors) {
    for (const char* text :
         {"surface,emissivty\n1,0.5\n", "surface,heat,heat\n1,1,1\n", "surface,heat\n1,1,2\n", "surface,heat\n1\n",
          "surface,temperature,heat\n1,300,5\n", "surface;heat\n1;1\n", "surface,emissivity\n1,0\n",
          "surface,temperature\n1,-1\n", "surface,heat\n1,x\n", "", "surface,heat\n,1\n", "surface,heat\n3,1\n",
          "surface,heat\n1.5,1\n", "surface,heat\n1,nan\n", "surface,emissivity\n0,NaN\n", "surface,heat\n-1,1\n",
          "heat\n1\n"})
        EXPECT_FALSE(read(text)) << text;
}

TEST(ThermalTable, ResultsHaveARowPerSurface) {
    const SparseFactors factors = two_spheres();
    const auto surfaces = read("surface,temperature\n1,500\n2,300\n");
    ASSERT_TRUE(surfaces);
    const auto exchange = solve_gray_exchange(factors, *surfaces, {}, StopRequest());
    ASSERT_TRUE(exchange) << exchange.error().message;
    const std::string text = heat_csv(factors, *surfaces, *exchange);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
    EXPECT_NE(text.find("\n1,1,0.80000000000000004,500,"), std::string::npos) << text;
    EXPECT_EQ(exchange_csv(factors, *surfaces, {{0.5, 0.25}, {0.0625, 0.5}}).substr(0, 36),
              "surface,area,emissivity,f_1,f_2\n1,1,");
}

}  // namespace
}  // namespace exitance
