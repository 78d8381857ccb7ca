#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/input_files.hpp"
#include "cli/small_scene.hpp"

namespace exitance::test {
namespace {

/// A day of daylight in a room without a ceiling, half of which is covered by a pane.
class StatesOfCourt : public testing::Test {
  protected:
    StatesOfCourt() {
        write_text(folder_ / "court.mtl", "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl glass\nKd 0 0 0\nd 0.1\n");
        write_text(folder_ / "court.obj",
                   "mtllib court.mtl\nv 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2.5\nv 4 0 2.5\nv 4 3 2.5\nv 0 3 2.5\n"
                   "v 2 0 2.5\nv 2 3 2.5\nusemtl grey\nf 1 2 3 4\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n"
                   "g roof\nusemtl glass\nf 5 9 10 8\n");
        write_text(folder_ / "lid.obj", "v 0 0 2.4\nv 2 0 2.4\nv 2 3 2.4\nv 0 3 2.4\nf 1 2 3 4\nf 4 3 2 1\n");
        write_text(folder_ / "w.epw", weather_of_a_day());
        write_text(folder_ / "p.csv", "x,y,z,nx,ny,nz\n1,1.5,0.8,0,0,1\n1.4,1.5,0.8,0,0,1\n");
    }

    /// Runs daylight with groups of states; `more`: further words.
    Finished run(const std::string& states, const std::vector<std::string>& more = {}) const {
        write_text(folder_ / "states.toml", states);
        std::vector<std::string> words{"daylight",
                                       folder_ / "court.obj",
                                       "--epw",
                                       folder_ / "w.epw",
                                       "--points",
                                       folder_ / "p.csv",
                                       "--error",
                                       "0.1",
                                       "-o",
                                       folder_ / "year",
                                       "--json",
                                       "--target",
                                       "20000",
                                       "--states",
                                       folder_ / "states.toml"};
        words.insert(words.end(), more.begin(), more.end());
        return run_program(words);
    }

    TemporaryFolder folder_;
};

const std::string open_and_shut = "[[group.state]]\nname = 'open'\n[[group.state]]\nname = 'shut'\n";

std::string group(const std::string& words) {
    return "[[group]]\nname = 'roof'\n" + words + "\n";
}

double number(const Finished& run, const std::string& key) {
    return nlohmann::json::parse(run.out).at(key).get<double>();
}

}  // namespace

TEST_F(StatesOfCourt, FactorsFilesAndSchedulesChangeTheLight) {
    const std::string glass = "materials = ['glass']\n", constant = "rule = 'constant'\nstays = ";
    const Finished open = run(group(glass + constant + "'open'") + open_and_shut);
    ASSERT_EQ(open.status, 0) << open.err;
    const auto electric = [&](const std::string& words) {
        const Finished ran = run(words);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return number(ran, "mean_electric_hours");
    };
    const double none = number(open, "mean_electric_hours"),
                 shut = electric(group("objects = ['roof']\n" + constant + "'shut'") + open_and_shut + "factor = 0\n"),
                 lid = electric(group("box = [0, 0, 2, 2, 3, 3]\n" + constant + "'shut'") + open_and_shut +
                                "files = ['lid.obj']\n");
    EXPECT_GT(shut, none);
    // Below the lid, no light of the pane arrives straight. Half of the court stays open.
    EXPECT_GT(lid, none);
    EXPECT_NEAR(lid, shut, 0.3 * shut);
    std::string table = "hour,roof\n";
    for (int h = 1; h <= 24; ++h) table += std::to_string(h) + (h > 12 ? ",1\n" : ",0\n");
    write_text(folder_ / "plan.csv", table);
    const double half =
        electric(group(glass + "rule = 'schedule'\nschedule = 'plan.csv'") + open_and_shut + "factor = 0\n");
    EXPECT_GT(half, none);
    EXPECT_LT(half, shut);
    const std::string states = read_text(folder_ / "year/states.csv");
    EXPECT_EQ(states.find("month,day,hour,\"roof\"\n"), 0u) << states;
    EXPECT_NE(states.find(",12,0\n"), std::string::npos) << states;
    EXPECT_NE(states.find(",13,1\n"), std::string::npos) << states;
}

TEST_F(StatesOfCourt, VariantsOfGlassHaveATable) {
    const std::string states = group("rule = 'constant'\nstays = 'open'") + open_and_shut;
    const Finished ran = run(states + "[[variant]]\nname = 'dark'\nfactors = [0.5]\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    const std::string table = read_text(folder_ / "year/variants.csv");
    EXPECT_EQ(table.find("variant,\"roof\",sDA_20000_50,sDA_20000_50_low,sDA_20000_50_high,mean_cDA_20000,mean_E,"
                         "ASE_1000_250\n\"dark\",0.5,"),
              0u)
        << table;
    const Finished fault = run(states + "[[variant]]\nname = 'dark'\nfactors = [0.5, 1]\n");
    EXPECT_EQ(fault.status, 3);
    EXPECT_NE(fault.err.find("'factors' must be a number from 0 to 1 for each of the 1 groups"), std::string::npos);
}

TEST_F(StatesOfCourt, SaysWhySdaIsNotThatOfLm83) {
    const Finished ran = run(group("rule = 'lm83'") + open_and_shut + "factor = 0.1\n");
    ASSERT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(number(ran, "sDA_conforms_to_LM83"), 0);
    const nlohmann::json deviations = nlohmann::json::parse(ran.out).at("sDA_deviations");
    ASSERT_EQ(deviations.size(), 2u) << deviations;
    EXPECT_EQ(deviations[0], "the weather is not that of a whole year");
}

/// A court of 4 x 3 x 2.5 m with a pane over half of it, in a Honeybee model: the pane has a state with a lid below it,
/// and the shade 'lid', which is below the open half, is black or missing.
std::string court_model() {
    const auto sheet = [](const std::string& name, const std::string& corners, const std::string& radiance) {
        return "{\"identifier\": \"" + name + "\", \"geometry\": {\"boundary\": [" + corners +
               "]}, \"properties\": {\"radiance\": {" + radiance + "}}}";
    };
    const std::string wall = "\"modifier\": \"generic_wall_0.50\"", black = "{\"modifier\": \"black\"}";
    std::string out =
        "{\"type\": \"Model\", \"properties\": {\"radiance\": {\"modifiers\": [{\"type\": \"Plastic\", "
        "\"identifier\": \"black\"}]}},\n\"orphaned_shades\": [";
    for (const std::string corners : {"[0,0,0],[4,0,0],[4,3,0],[0,3,0]", "[0,0,0],[0,0,2.5],[4,0,2.5],[4,0,0]",
                                      "[4,0,0],[4,0,2.5],[4,3,2.5],[4,3,0]", "[4,3,0],[4,3,2.5],[0,3,2.5],[0,3,0]",
                                      "[0,3,0],[0,3,2.5],[0,0,2.5],[0,0,0]"})
        out += sheet("wall", corners, wall) + ",\n";
    out += sheet("lid", "[2,0,2.4],[4,0,2.4],[4,3,2.4],[2,3,2.4]",
                 "\"dynamic_group_identifier\": \"cover\", \"states\": [{\"modifier\": \"void\"}, " + black + "]");
    const std::string glass = "\"modifier\": \"generic_exterior_window_vis_0.64\"";
    return out + "],\n\"orphaned_apertures\": [" +
           sheet("roof", "[0,0,2.5],[2,0,2.5],[2,3,2.5],[0,3,2.5]",
                 "\"dynamic_group_identifier\": \"roofs\", \"states\": [{" + glass + "}, {" + glass +
                     ", \"shades\": [" +
                     sheet("blind", "[0,0,2.4],[2,0,2.4],[2,3,2.4],[0,3,2.4]", "\"modifier\": \"black\"") + "]}]") +
           "]}\n";
}

TEST_F(StatesOfCourt, OfHoneybeeModelsMayHaveShades) {
    write_text(folder_ / "court.hbjson", court_model());
    const auto daylight = [&](const std::string& name, const std::string& state, const std::string& more = "") {
        write_text(folder_ / "states.toml", "# a comment\n\n[[group]]\nname = 'a'\ndynamic_group = '" + name +
                                                "'\nrule = 'constant'\nstays = '" + state + "'\n" + more);
        return run_program({"daylight", folder_ / "court.hbjson", "--epw", folder_ / "w.epw", "--points",
                            folder_ / "p.csv", "--error", "0.1", "-o", folder_ / "year", "--json", "--target", "20000",
                            "--states", folder_ / "states.toml"});
    };
    const auto electric = [&](const std::string& name, const std::string& state) {
        const Finished ran = daylight(name, state);
        EXPECT_EQ(ran.status, 0) << ran.err;
        EXPECT_EQ(ran.err.find("twice"), std::string::npos) << ran.err;
        return number(ran, "mean_electric_hours");
    };
    const double open = electric("roofs", "0");
    EXPECT_EQ(electric("cover", "0"), open);
    // The sensors are below the glass: a blind there takes more light than a lid over the other half.
    const double covered = electric("cover", "1"), blind = electric("roofs", "1");
    EXPECT_GT(covered, 1.1 * open);
    EXPECT_GT(blind, covered);

    const std::string second = "[[group]]\nname = 'b'\ndynamic_group = 'roofs'\nrule = 'lm83'\n";
    const Finished both = daylight("cover", "1", second);
    EXPECT_EQ(both.status, 3);
    EXPECT_NE(both.err.find("states.toml:8: group 'a' has shades, which change the light of all groups"),
              std::string::npos)
        << both.err;
    const Finished own_states = daylight("cover", "1", open_and_shut);
    EXPECT_NE(own_states.err.find("'cover' has shades, whose states are those of the model"), std::string::npos);
    const Finished none = daylight("nothing", "1");
    EXPECT_NE(none.err.find("states.toml:3: the model has no dynamic objects of group 'nothing'"), std::string::npos)
        << none.err;
}

TEST_F(StatesOfCourt, FaultsOfTheFileAreErrorsWithTheirLine) {
    const std::vector<std::pair<std::string, std::string>> faults{
        {"", "has no groups of panes"},
        {group("rule = 'lm83'"), "group 'roof' has fewer than two states"},
        {group("materials = ['wood']\nrule = 'lm83'") + open_and_shut, "group 'roof' has none of the scene's 1 panes"},
        {group("rule = 'wind'") + open_and_shut, "'wind' is not a rule"},
        {group("rule = 'constant'\nstays = 'ajar'") + open_and_shut, "group 'roof' has no state 'ajar'"},
        {group("rule = 'lm83'") + open_and_shut + "factor = 2\n", "'factor' must be from 0 to 1, not 2"},
        {group("rule = 'lm83'") + "[[group.state]]\nname = 'a'\nfactor = 0.5\n" + open_and_shut,
         "the first state has a factor or files"},
        {group("rule = 'lm83'") + open_and_shut + "files = ['none.obj']\n", "there is no such file"},
        {group("rule = 'illuminance'\nsensors = [2]\nlimits = [500]") + open_and_shut, "there is no sensor 2"},
        {group("rule = 'illuminance'\nsensors = [1]\nlimits = [5, 6]") + open_and_shut, "'limits' must be 1 ascending"},
        {group("rule = 'schedule'\nschedule = 'p.csv'") + open_and_shut, "roof"},
        {group("rule = 'lm83'\nbox = [1, 2, 3]") + open_and_shut, "'box' is not of the form"},
        {group("rule = 'lm83'") + open_and_shut + "[[group]]\nname = 'b'\nrule = 'lm83'\n" + open_and_shut,
         "groups 'roof' and 'b' have a pane in common"},
        {group("rule = 'lm83'\ncolour = 1") + open_and_shut, "'colour' is not known here"}};
    for (const auto& [words, message] : faults) {
        const Finished ran = run(words);
        EXPECT_EQ(ran.status, 3) << words;
        EXPECT_NE(ran.err.find(message), std::string::npos) << words << ran.err;
    }
    EXPECT_EQ(run(group("rule = 'lm83'") + open_and_shut, {"--part", "1/2"}).status, 2);
}

}  // namespace exitance::test
