#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>

#include "cli/small_scene.hpp"
#include "support/places.hpp"

namespace exitance::test {
namespace {

/// Returns the numbers after a key, up to the closing bracket.
std::vector<double> numbers_after(const std::string& json, const std::string& key, std::size_t from = 0) {
    std::vector<double> out;
    std::size_t at = json.find("\"" + key + "\": [", from);
    if (at == std::string::npos) return out;
    at = json.find('[', at) + 1;
    const std::string list = json.substr(at, json.find(']', at) - at);
    std::istringstream in(std::regex_replace(list, std::regex(","), " "));
    for (double value; in >> value;) out.push_back(value);
    return out;
}

}  // namespace

TEST(ProgramReport, IsOnePageWithItsNumbersBesideIt) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", page = folder / "room.html";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const Finished run = run_program({"report", solution, "-o", page, "--size", "64x40", "--grid",
                                      "0.5,0.5,0 3,0,0 0,2,0 0.5", "--grid", "1,1,1 1,0,0 0,1,0 auto 0.1"});
    ASSERT_EQ(run.status, 0) << run.err;
    const std::string html = read_text(page), json = read_text(folder / "room.json");
    for (const std::string id :
         {"pictures", "walk", "grids", "materials", "surfaces", "energy", "error", "method", "warnings"})
        EXPECT_NE(html.find("<section id=\"" + id + "\">"), std::string::npos) << id;
    EXPECT_EQ(html.find("src=\"http"), std::string::npos);
    EXPECT_EQ(html.find("href=\"http"), std::string::npos);
    // The page contains the JSON file unchanged, and its tables show the same numbers.
    EXPECT_NE(html.find(json), std::string::npos);
    std::smatch mean;
    ASSERT_TRUE(
        std::regex_search(json, mean, std::regex("\"surface\": 0,.*\"irradiance\": \\{\"mean\": ([0-9.e-]+),")));
    EXPECT_NE(html.find("<td>" + mean[1].str() + "</td>"), std::string::npos);

    const std::vector<double> values = numbers_after(json, "values");
    ASSERT_EQ(values.size(), 6u * 4u);
    std::string points = "x,y,z,nx,ny,nz\n";
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 6; ++column)
            points += std::to_string(0.75 + 0.5 * column) + "," + std::to_string(0.75 + 0.5 * row) + ",0,0,0,1\n";
    const Finished probe = run_program({"probe", solution, "--points", "-"}, points);
    ASSERT_EQ(probe.status, 0) << probe.err;
    std::istringstream lines(probe.out);
    std::string line;
    std::getline(lines, line);
    for (const double value : values) {
        std::getline(lines, line);
        double x, y, z, nx, ny, nz, r, g, b;
        ASSERT_EQ(
            std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &x, &y, &z, &nx, &ny, &nz, &r, &g, &b), 9)
            << line;
        EXPECT_NEAR(value, (r + g + b) / 3, 1e-4 * value);  // five digits
    }
}

TEST(ProgramReport, MaterialsOfOneNameAreOneRow) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), solution = folder / "room.h5";
    // A second lamp, of a group of its own: light groups give its faces a material of their own.
    write_text(scene, read_text(scene) + "v 0.5 1 2.3\nv 1 1 2.3\nv 1 2 2.3\nv 0.5 2 2.3\ng spare\nf 16 15 14 13\n");
    ASSERT_EQ(run_program({"solve", scene, "-o", solution, "--error", "0.1", "--light-groups", "-q"}).status, 0);
    ASSERT_EQ(run_program({"report", solution, "-o", folder / "room.html", "--size", "32x20", "-q"}).status, 0);
    const nlohmann::json found = nlohmann::json::parse(read_text(folder / "room.json"))["materials"];
    ASSERT_EQ(found.size(), 2u) << found;
    EXPECT_EQ(found[1]["name"], "lamp");
    EXPECT_EQ(found[1]["surfaces"], 2);
    EXPECT_NEAR(double(found[1]["area"]), 1.5, 1e-4);
}

TEST(ProgramReport, JudgesRequirementsWithTheErrorOfTheLight) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", page = folder / "room.html";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const auto report = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"report", solution, "-o",     page,
                                       "--size", "64x40",  "--grid", "0.5,0.5,0 3,0,0 0,2,0 0.5"};
        words.insert(words.end(), more.begin(), more.end());
        return run_program(words);
    };
    ASSERT_EQ(report({"-q"}).status, 0);
    const nlohmann::json plain = nlohmann::json::parse(read_text(folder / "room.json"));
    const double mean = plain["grids"][0]["mean"], error = plain["statistics"]["relative_error_estimate"];
    EXPECT_TRUE(plain["requirements"].empty());
    const auto require = [&](double factor) { return "Em " + std::to_string(factor * mean); };
    const Finished judged = report({"--require", require(0.9), "--require", require(1 + 0.5 * error), "--require",
                                    require(1 + 2 * error), "--require", "UGR 19", "--require", "Ez 10", "--title",
                                    "Room <1>", "--client", "A & B", "--tables", folder / "tables"});
    ASSERT_EQ(judged.status, 0) << judged.err;
    const nlohmann::json json = nlohmann::json::parse(read_text(folder / "room.json"));
    const std::vector<std::string> verdicts{"reached", "reached within the error", "missed", "not measured",
                                            "not measured"};
    ASSERT_EQ(json["requirements"].size(), verdicts.size());
    for (std::size_t i = 0; i < verdicts.size(); ++i) EXPECT_EQ(json["requirements"][i]["verdict"], verdicts[i]) << i;
    const std::string html = read_text(page);
    EXPECT_NE(html.find("<h1>Room &lt;1&gt;</h1>"), std::string::npos);
    EXPECT_NE(html.find("A &amp; B"), std::string::npos);
    EXPECT_EQ(html.find("--camera"), std::string::npos) << "captions are words, not options";
    EXPECT_NE(read_text(folder / "tables/requirements.csv").find(",missed\n"), std::string::npos);
    EXPECT_NE(read_text(folder / "tables/surfaces.csv").find("surface,line,group"), std::string::npos);
    for (const char* wrong : {"Em", "Em -5", "Em 500 600", "lux 500", "desk: UGR 19", ""})
        EXPECT_EQ(report({"--require", wrong}).status, 2) << wrong;
    EXPECT_EQ(run_program({"report", solution, "-o", page, "--require", "Em 500"}).status, 2) << "nothing is measured";
}

TEST(ProgramReport, JudgesTheZonesAroundATaskArea) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), solution = folder / "room.h5";
    write_text(scene, read_text(scene) +
                          "v 1.5 1 0.7\nv 2.5 1 0.7\nv 2.5 2 0.7\nv 1.5 2 0.7\nusemtl grey\ng desk\nf 13 14 15 16\n");
    ASSERT_EQ(run_program({"solve", scene, "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const auto report = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"report", solution, "-o", folder / "room.html", "--size", "16x10", "-q"};
        words.insert(words.end(), more.begin(), more.end());
        EXPECT_EQ(run_program(words).status, 0);
        return nlohmann::json::parse(read_text(folder / "room.json"))["requirements"];
    };
    const auto judged =
        report({"--unit", "lux", "--plane", "desk,around=0.5,background=3", "--require", "desk: Em 500, U0 0.6"});
    ASSERT_EQ(judged.size(), 6u);
    const std::vector<double> required{500, 300, 100, 0.6, 0.4, 0.1};
    for (std::size_t i = 0; i < required.size(); ++i) EXPECT_NEAR(judged[i]["required"], required[i], 0.01) << i;
    EXPECT_EQ(judged[2]["where"], "desk, background");
    const auto dim = report({"--unit", "lux", "--plane", "desk,around=0.5,background=3", "--task", "school-stairs"});
    ASSERT_EQ(dim.size(), 3u);  // up to 200 lx the surroundings need as much as the task
    EXPECT_EQ(dim[1]["required"], 150);
    EXPECT_EQ(dim[2]["required"], 50);
    // The steps are in lx.
    EXPECT_EQ(report({"--unit", "w", "--plane", "desk,around=0.5", "--require", "Em 5"}).size(), 1u);
    EXPECT_EQ(run_program({"report", solution, "--plane", "0.75,background=3", "--tables", folder / "t"}).status, 2);
}

TEST(ProgramReport, PrintsAPdfOrSaysWhatIsMissing) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", page = folder / "room.html", pdf = folder / "room.pdf";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const Finished run = run_program({"report", solution, "-o", page, "--size", "64x40", "--pdf", pdf});
    if (run.status == 0) {
        EXPECT_EQ(read_text(pdf).substr(0, 5), "%PDF-");
    } else {
        EXPECT_EQ(run.status, 5) << run.err;
        EXPECT_NE(run.err.find("hromium"), std::string::npos) << run.err;
        EXPECT_FALSE(std::filesystem::exists(pdf));
    }
    EXPECT_EQ(
        run_program({"report", solution, "--tables", folder / "t", "--grid", "0,0,0 1,0,0 0,1,0 0.5", "--pdf", pdf})
            .status,
        2);
}

TEST(ProgramReport, EscapesNamesAndShowsLuxOnRequest) {
    const TemporaryFolder folder;
    const std::string scene = write_small_room(folder), solution = folder / "room.h5", page = folder / "room.html";
    std::string text = read_text(scene);
    text.replace(text.find("g floor"), 7, "g <b>&</script>");
    write_text(scene, text);
    ASSERT_EQ(run_program({"solve", scene, "-o", solution, "--error", "0.1", "-q"}).status, 0);
    ASSERT_EQ(run_program({"report", solution, "-o", page, "--size", "32x20", "--unit", "lux", "--camera",
                           "0.5,0.5,1 3,2,1 60", "--camera", "auto", "-q"})
                  .status,
              0);
    const std::string html = read_text(page);
    EXPECT_NE(html.find("&lt;b&gt;&amp;&lt;/script&gt;"), std::string::npos);
    EXPECT_EQ(html.find("<b>&</script>"), std::string::npos);
    EXPECT_NE(html.find("Illuminance in lx"), std::string::npos);
    EXPECT_NE(read_text(folder / "room.json").find("\"unit\": \"lx\""), std::string::npos);
}

TEST(ProgramReport, RejectsInvalidOptions) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", page = folder / "room.html";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    EXPECT_EQ(run_program({"report", solution, "-o", folder / "room.pdf"}).status, 2);
    EXPECT_EQ(run_program({"report", solution, "-o", page, "--grid", "1,2,3"}).status, 2);
    EXPECT_EQ(run_program({"report", solution, "-o", page, "--grid", "0,0,0 1,0,0 0,1,0 -1"}).status, 2);
    EXPECT_EQ(run_program({"report", solution, "-o", page, "--grid", "0,0,0 1,0,0 2,0,0 0.1"}).status, 2);
    EXPECT_EQ(run_program({"report", solution, "-o", page, "--camera", "nowhere"}).status, 2);
    EXPECT_EQ(run_program({"report", folder / "absent.h5", "-o", page}).status, 3);
    EXPECT_FALSE(std::filesystem::exists(page));
}

TEST(ProgramReport, LuxAreWattsByTheEfficacy) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", points = "x,y,z,nx,ny,nz\n1,1,0,0,0,1\n";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const auto last = [&](std::vector<std::string> more, double* bands) {
        std::vector<std::string> words{"probe", solution, "--points", "-"};
        words.insert(words.end(), more.begin(), more.end());
        const Finished run = run_program(words, points);
        EXPECT_EQ(run.status, 0) << run.err;
        const std::string row = run.out.substr(run.out.find('\n') + 1);
        EXPECT_EQ(std::sscanf(row.c_str(), "1,1,0,0,0,1,%lf,%lf,%lf", bands, bands + 1, bands + 2), 3) << row;
        return std::stod(row.substr(row.rfind(',') + 1));
    };
    double E[3];
    const double lux = last({"--unit", "lux"}, E);
    const double expected = 0.265 * E[0] + 0.670 * E[1] + 0.065 * E[2];
    EXPECT_NEAR(lux, 179 * expected, 1e-6 * lux);
    EXPECT_NEAR(last({"--unit", "lux", "--efficacy", "100"}, E), 100 * expected, 1e-6 * lux);
    EXPECT_NEAR(last({"--unit", "w"}, E), (E[0] + E[1] + E[2]) / 3, 1e-6 * lux);
    EXPECT_EQ(run_program({"probe", solution, "--points", "-", "--efficacy", "100"}, points).status, 2);
    EXPECT_EQ(run_program({"render", solution, "-o", folder / "a.png", "--unit", "lux"}).status, 2);
    EXPECT_EQ(run_program({"render", solution, "-o", folder / "a.png", "--unit", "lux", "--false-colour", "irradiance",
                           "--size", "16x10", "-q"})
                  .status,
              0);
}

/// The page, results and tables of a room of 4 x 3 m with a lamp.
class ProgramReportOfARoom : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        ASSERT_EQ(run_program({"solve", write_small_room(*folder_), "-o", solution(), "--error", "0.1", "-q"}).status,
                  0);
        const Finished run =
            report({"--unit", "lux", "--plane", "0.75", "--plane", "floor,border=0.2,spacing=0.5", "--cylindrical",
                    "1.2,spacing=1", "--maintenance", "0.8", "--observers", "auto", "--observers", "0.2,1.5,1.2 1,0,0",
                    "--observers", "1.9,1.5,1.2 1,0,0", "--tables", path("t")});
        ASSERT_EQ(run.status, 0) << run.err;
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string path(const std::string& name) { return *folder_ / name; }
    static std::string solution() { return path("room.h5"); }
    static Finished report(const std::vector<std::string>& more) {
        std::vector<std::string> words{"report", solution(), "-o", path("r.html"), "--size", "16x10", "-q"};
        words.insert(words.end(), more.begin(), more.end());
        return run_program(words);
    }
    static nlohmann::json results() { return nlohmann::json::parse(read_text(path("r.json"))); }

  private:
    static inline std::unique_ptr<TemporaryFolder> folder_;
};

TEST_F(ProgramReportOfARoom, MeasuresWorkingPlanesByStandards) {
    const auto json = results();
    ASSERT_EQ(json["grids"].size(), 3u);
    const auto& plane = json["grids"][0];
    // 4 x 3 m without 0.5 m on every side are 3 x 2 m. With p = 0.2 x 5^log10(3) = 0.431 m, there are 7 x 5 points.
    EXPECT_EQ(plane["columns"], 7);
    EXPECT_EQ(plane["rows"], 5);
    EXPECT_EQ(plane["name"], "0.75 m above floor");
    EXPECT_EQ(json["grids"][2]["kind"], "cylindrical");
    double sum = 0, least = 1e9;
    for (const double v : plane["values"]) sum += v / 35, least = std::min(least, v);
    EXPECT_NEAR(plane["mean"], sum, 1e-4 * sum);
    EXPECT_NEAR(plane["uniformity"], least / sum, 1e-4);
    // `probe` at the same points, in watts times the factor.
    const auto& p = plane["points"][9];
    const Finished probe =
        run_program({"probe", solution(), "--points", "-", "--unit", "lux"},
                    "x,y,z,nx,ny,nz\n" + p[0].dump() + "," + p[1].dump() + "," + p[2].dump() + ",0,0,1\n");
    EXPECT_NEAR(plane["values"][9], 0.8 * std::stod(probe.out.substr(probe.out.rfind(',') + 1)), 1e-3 * sum);
}

TEST_F(ProgramReportOfARoom, RatesTheGlareOfObservers) {
    const auto json = results();
    ASSERT_EQ(json["observers"].size(), 6u);
    const auto& observer = json["observers"][4];
    ASSERT_EQ(observer["sources"].size(), 1u);
    const auto& source = observer["sources"][0];
    EXPECT_NEAR(source["luminance"], 10 * 179, 0.1);
    const double term = std::pow(source["luminance"].get<double>() / source["position"].get<double>(), 2) *
                        source["solid_angle"].get<double>();
    EXPECT_NEAR(observer["ugr"], 8 * std::log10(0.25 * term / observer["background"].get<double>()), 1e-2);
    EXPECT_TRUE(observer["left_out"].empty());
    // For the sixth observer, the lamp is overhead.
    EXPECT_TRUE(json["observers"][5]["ugr"].is_null());
    EXPECT_TRUE(json["observers"][5]["sources"].empty());
    ASSERT_EQ(json["observers"][5]["left_out"].size(), 1u);
    EXPECT_EQ(json["observers"][5]["left_out"][0]["name"], "lamp");
    EXPECT_EQ(json["observers"][5]["left_out"][0]["reason"].get<std::string>().find("overhead"), 0u);
}

TEST_F(ProgramReportOfARoom, WritesTablesAndDrawings) {
    EXPECT_NE(read_text(path("t/observers.csv")).find(",large_source,left_out\n"), std::string::npos);
    const std::string table = read_text(path("t/planes.csv"));
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 4);
    EXPECT_TRUE(read_text(path("t/plane_1.svg")).starts_with("<svg xmlns"));
    EXPECT_TRUE(read_text(path("t/plane_3.pdf")).starts_with("%PDF"));
    EXPECT_NE(read_text(path("t/observers.csv")).find("\"looking +x\""), std::string::npos);
    EXPECT_NE(read_text(path("r.html")).find("<section id=\"glare\">"), std::string::npos);
    // Writes only tables, without a page.
    EXPECT_EQ(run_program({"report", solution(), "--plane", "0.75", "--tables", path("u"), "-q"}).status, 0);
    EXPECT_TRUE(std::filesystem::exists(path("u/plane_1.csv")));
}

TEST_F(ProgramReportOfARoom, RejectsOptionsThatDoNotFit) {
    for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{{"--plane", "chair"},
                                                                                       {"--plane", "0.7,size=3"},
                                                                                       {"--cylindrical", "floor"},
                                                                                       {"--observers", "1,2,3 0,0,0"},
                                                                                       {"--maintenance", "1.2"}})
        EXPECT_EQ(report(wrong).status, 2) << wrong[1];
    EXPECT_EQ(report({"--observers", path("none.csv")}).status, 3);
    EXPECT_EQ(run_program({"report", solution(), "-q"}).status, 2);
    EXPECT_EQ(run_program({"report", solution(), "--tables", path("u")}).status, 2);
    EXPECT_EQ(run_program({"report", solution(), "-o", path("r.html"), "--maintenance", "0.8"}).status, 2);
}

TEST(ProgramReport, IsGermanOrShortByATemplate) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", page = folder / "room.html", order = folder / "order.toml";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const auto report = [&](const std::string& words) {
        return run_program({"report", solution, "-o", page, "--size", "16x10", "--unit", "lux", "--task", "office",
                            "--project", "Haus 3", "--template", words, "-q"});
    };
    ASSERT_EQ(report("german").status, 0);
    std::string german = read_text(page);
    EXPECT_NE(german.find("<html lang=\"de\">"), std::string::npos);
    EXPECT_NE(german.find("<h2>Energiebilanz</h2>"), std::string::npos);
    EXPECT_NE(german.find("Blick nach +x"), std::string::npos);
    // Numbers for programs stay as they are.
    EXPECT_TRUE(nlohmann::json::parse(read_text(folder / "room.json")).contains("grids"));
    for (std::size_t at = 0; (at = german.find("<script")) != std::string::npos;)
        german.erase(at, german.find("</script>", at) - at);
    german.erase(german.find("<style"), german.find("</style>") - german.find("<style"));
    for (const char* english :
         {" the ", " of ", " is ", " are ", " and ", "Mean ", "Minimum", ">reached", "at least", "Where"})
        EXPECT_EQ(german.find(english), std::string::npos)
            << german.substr(std::max<std::size_t>(german.find(english), 60) - 60, 160);
    write_text(order, "sections = [\"energy\", \"rooms\"]\n[words]\n\"Energy balance\" = \"Watts\"\n");
    ASSERT_EQ(report(order).status, 0);
    const std::string brief = read_text(page);
    EXPECT_LT(brief.find("<h2>Watts</h2>"), brief.find("<h2>Rooms</h2>"));
    EXPECT_EQ(brief.find("<h2>Pictures</h2>"), std::string::npos);
    EXPECT_EQ(report(folder / "absent.toml").status, 3);
    EXPECT_EQ(
        run_program({"report", solution, "--plane", "0.75", "--tables", folder / "t", "--template", "german"}).status,
        2);
    EXPECT_NE(run_program({"report", "--list-words"}).out.find("\"Energy balance\" = \"Energiebilanz\""),
              std::string::npos);
}

TEST(ProgramReport, JudgesRoomsByTheirTasks) {
    const TemporaryFolder folder;
    const std::string solution = folder / "room.h5", page = folder / "room.html", own = folder / "own.toml";
    ASSERT_EQ(run_program({"solve", write_small_room(folder), "-o", solution, "--error", "0.1", "-q"}).status, 0);
    const Finished list = run_program({"report", "--list-tasks"});
    ASSERT_EQ(list.status, 0) << list.err;
    EXPECT_NE(list.out.find("office"), std::string::npos);
    EXPECT_NE(list.out.find("EN 12464-1:2021"), std::string::npos);
    const auto report = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"report", solution, "-o", page, "--size", "16x10", "--unit", "lux", "-q"};
        words.insert(words.end(), more.begin(), more.end());
        return run_program(words);
    };
    // Planes and observers that the task needs are added.
    const Finished office = report({"--task", "office"});
    ASSERT_EQ(office.status, 0) << office.err;
    const auto json = nlohmann::json::parse(read_text(folder / "room.json"));
    ASSERT_EQ(json["rooms"].size(), 1u);
    EXPECT_NEAR(json["rooms"][0]["area"], 12, 1e-3);
    ASSERT_EQ(json["grids"].size(), 1u);
    EXPECT_EQ(json["grids"][0]["room"], 1);
    EXPECT_EQ(json["observers"].size(), 4u);
    ASSERT_EQ(json["requirements"].size(), 4u);
    for (const auto& r : json["requirements"]) EXPECT_EQ(r["task"], "office (EN 12464-1:2021)");
    EXPECT_EQ(json["requirements"][0]["required"], 500);
    EXPECT_EQ(json["requirements"][0]["reached"], json["grids"][0]["mean"]);
    EXPECT_EQ(json["requirements"][3]["quantity"], "Ra");
    EXPECT_EQ(json["requirements"][3]["verdict"], "not measured");
    // The user's own tasks, by room.
    write_text(own, "edition = \"house\"\n[[task]]\nname = \"dim\"\nEm = 1\nEz = 1\n");
    ASSERT_EQ(report({"--tasks", own, "--task", "office", "--task", "1=dim"}).status, 0);
    const auto dim = nlohmann::json::parse(read_text(folder / "room.json"));
    ASSERT_EQ(dim["requirements"].size(), 2u);
    EXPECT_EQ(dim["requirements"][1]["verdict"], "reached");
    for (const std::vector<std::string>& wrong :
         std::vector<std::vector<std::string>>{{"--task", "ofice"}, {"--task", "7=office"}, {"--tasks", own}})
        EXPECT_EQ(report(wrong).status, 2) << wrong[1];
    for (const char* text :
         {"[[task]]\nname = \"a\"\nEm = -1\n", "[[task]]\nname = \"a\"\nlux = 5\n", "task = 1\n", "[[", ""}) {
        write_text(own, text);
        EXPECT_EQ(report({"--tasks", own, "--task", "office"}).status, 3) << text;
    }
    EXPECT_EQ(run_program({"report", "-o", page}).status, 2) << "no solution";
}

}  // namespace exitance::test
