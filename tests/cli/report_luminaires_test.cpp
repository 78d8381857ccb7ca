#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/small_scene.hpp"
#include "support/places.hpp"

namespace exitance::test {
namespace {

/// Places luminaires of two photometric files into the small room: three of 753.5 lm and 20 W, the last of them at half
/// its output, and one of 20 W. Returns the path of the table.
std::string write_luminaires(const TemporaryFolder& folder) {
    for (const char* file : {"quadrant.ldt", "bilateral_0_180.ies"})
        std::filesystem::copy_file(std::filesystem::path(data_folder()) / "formats/samples" / file, folder / file,
                                   std::filesystem::copy_options::overwrite_existing);
    write_text(folder / "l.csv",
               "file,x,y,z,dimming,maintenance_factor,group\nquadrant.ldt,0.8,0.8,2.4,,0.8,\n"
               "quadrant.ldt,0.8,2.2,2.4,,0.8,\nquadrant.ldt,3.2,2.2,2.4,0.5,0.8,row\n"
               "bilateral_0_180.ies,3.2,0.8,2.4,,,\n");
    return folder / "l.csv";
}

/// Solves the small room with the luminaires of a table and writes a page with its tables. Returns the page's numbers.
nlohmann::json report_on_luminaires(const TemporaryFolder& folder, const std::string& table) {
    const std::string solution = folder / "room.h5", page = folder / "room.html";
    EXPECT_EQ(
        run_program({"solve", write_small_room(folder), "--luminaires", table, "-o", solution, "--error", "0.1", "-q"})
            .status,
        0);
    const Finished run = run_program({"report", solution, "-o", page, "--size", "32x20", "--unit", "lux", "--plane",
                                      "0.75", "--tables", folder / "tables", "-q"});
    EXPECT_EQ(run.status, 0) << run.err;
    return nlohmann::json::parse(read_text(folder / "room.json"));
}

}  // namespace

TEST(ProgramReport, SchedulesLuminairesWithThePowerOfTheirFiles) {
    const TemporaryFolder folder;
    const nlohmann::json json = report_on_luminaires(folder, write_luminaires(folder));
    const auto& types = json["luminaires"]["types"];
    ASSERT_EQ(types.size(), 2u);
    // quadrant.ldt: lamps of 1000 lm with 20 W, and an output ratio of 75.35%.
    EXPECT_EQ(types[0]["file"], "quadrant.ldt");
    EXPECT_EQ(types[0]["name"], "synthetic quadrant");
    EXPECT_EQ(types[0]["count"], 3);
    EXPECT_NEAR(types[0]["flux"], 753.5, 0.5);
    EXPECT_EQ(types[0]["power"], 20);
    EXPECT_NEAR(types[0]["output"][0], 0.5, 1e-3);
    EXPECT_NEAR(types[0]["output"][1], 1, 1e-3);
    EXPECT_EQ(types[0]["maintenance"][0], 0.8);
    EXPECT_EQ(types[1]["power"], 20);  // the last number of the line "1 1 20" of the IES file
    const auto& room = json["luminaires"]["rooms"][0];
    EXPECT_EQ(room["power"], 80);
    EXPECT_NEAR(room["power_per_area"], 80.0 / 12, 1e-3);
    const double mean = json["grids"][0]["mean"];
    EXPECT_NEAR(room["power_per_area_100_lux"], 100 * 80.0 / 12 / mean, 0.01);
    // The lamp of the scene has no photometric file: 1 m^2 of 10 W/(m^2 sr).
    ASSERT_EQ(json["luminaires"]["others"].size(), 1u);
    EXPECT_NEAR(json["luminaires"]["others"][0]["flux"], 179 * 10 * 3.14159265, 1);
    const std::string html = read_text(folder / "room.html"), csv = read_text(folder / "tables/luminaires.csv");
    for (const char* part : {"<section id=\"luminaires\">", "class=\"polar\"", "class=\"layout\"", ">A3</text>"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
    EXPECT_NE(csv.find("A3,A,\"row #3\",\"quadrant.ldt\",\"room 1\",3.2,2.2,2.4,"), std::string::npos) << csv;
}

TEST(ProgramReport, DoesNotInventThePowerOfLuminaires) {
    const TemporaryFolder folder;
    const std::string table = write_luminaires(folder), file = folder / "quadrant.ldt";
    std::string text = read_text(file), name;
    for (int i = 0; i < 40; ++i) name += "\xc3\xa4";
    text = std::regex_replace(text, std::regex("(LED\\s+1000\\s+4000\\s+80\\s+)20"), "$010");
    text.replace(text.find("quadrant"), 8, name);
    write_text(file, text);
    const nlohmann::json json = report_on_luminaires(folder, table);
    EXPECT_TRUE(json["luminaires"]["types"][0]["power"].is_null());
    EXPECT_TRUE(json["luminaires"]["rooms"][0]["power"].is_null());
    EXPECT_TRUE(json["luminaires"]["rooms"][0]["power_per_area"].is_null());
    const std::string shown = json["luminaires"]["types"][0]["name"];
    EXPECT_NE(shown.find("\xc3\xa4\xc3\xa4"), std::string::npos) << shown;
    EXPECT_NE(read_text(folder / "room.html").find(">unknown<"), std::string::npos);
}

}  // namespace exitance::test
