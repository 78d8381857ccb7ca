#include <gtest/gtest.h>

#include "exitance/lab/study/study.hpp"
#include "exitance/lab/study/study_scene.hpp"
#include "exitance/lab/study/study_tables.hpp"

namespace exitance {
namespace {

const std::string smallest =
    "title = \"T\"\n"
    "[[scene]]\nname = \"tube\"\ngenerate = \"tube rho={value}\"\nvalues = [0.5, 0.9]\nquick = [0.5]\n"
    "[[row]]\nlabel = \"Haar\"\noptions = \"--method wavelet\"\n";

void expect_error(const std::string& text, const std::string& where, const std::string& message) {
    const Result<Study> study = parse_study(text, "s", "s.toml");
    ASSERT_FALSE(study) << text;
    EXPECT_EQ(study.error().code, ErrorCode::bad_input);
    EXPECT_EQ(study.error().where, where) << text;
    EXPECT_NE(study.error().message.find(message), std::string::npos) << study.error().message;
}

TEST(StudyFile, HoldsScenesAndRows) {
    const Result<Study> study = parse_study(smallest, "s", "folder/s.toml");
    ASSERT_TRUE(study) << study.error().message;
    EXPECT_EQ(study->folder, "folder");
    EXPECT_EQ(study->scenes.at(0).values, (std::vector<double>{0.5, 0.9}));
    EXPECT_EQ(study->scenes.at(0).quick_values, (std::vector<double>{0.5}));
    EXPECT_EQ(study->rows.at(0).options, "--method wavelet");
}

TEST(StudyFile, ReportsTheLineOfAnError) {
    expect_error("title = \n", "s.toml:1", "");
    expect_error("titel = \"T\"\n", "s.toml:1", "'title' is missing");
    expect_error(smallest + "colour = 1\n", "s.toml:10", "'colour' is not known here");
    expect_error(smallest + "most = \"x\"\n", "s.toml:10", "'most' is not a number");
    expect_error(smallest + "[[row]]\nlabel = \"Haar\"\noptions = \"\"\n", "s.toml:1", "two rows are called 'Haar'");
    expect_error(smallest + "[[conclusion]]\nsays = \"\"\ny = \"links\"\nmeasure = \"slop\"\n", "s.toml:13",
                 "'slop' is not one of");
    expect_error(smallest + "[reference]\npoints = 10\n", "s.toml:10", "a reference needs");
    expect_error("title = \"T\"\n", "s.toml:1", "a study needs");
}

TEST(StudyFile, EveryBuiltInStudyIsValid) {
    EXPECT_GE(built_in_studies().size(), 15u);
    for (const BuiltInStudy& built_in : built_in_studies()) {
        const Result<Study> study = parse_study(std::string(built_in.text), std::string(built_in.name), "s.toml");
        ASSERT_TRUE(study) << built_in.name << ": " << study.error().where << ": " << study.error().message;
        const auto makers = study_table_makers();
        const bool known = study->table.empty() || std::any_of(makers.begin(), makers.end(),
                                                               [&](const auto& m) { return m.name == study->table; });
        EXPECT_TRUE(known) << built_in.name;
        const auto is_row = [&](const std::string& text) {
            return std::any_of(study->rows.begin(), study->rows.end(),
                               [&](const StudyRow& row) { return row.label == text; });
        };
        if (!study->table.empty()) continue;
        for (const StudyConclusion& c : study->conclusions) {
            if (!c.where.contains("row")) continue;
            for (const std::string& text : c.where.at("row"))
                EXPECT_TRUE(is_row(text)) << built_in.name << ": " << text;
        }
    }
}

TEST(StudyWords, QuotesKeepBlanks) {
    EXPECT_EQ(split_words(" a  --camera \"1,2 3\" 'b c'"), (std::vector<std::string>{"a", "--camera", "1,2 3", "b c"}));
    EXPECT_EQ(filled_in("h={value} {value}", {{"value", "2"}}), "h=2 2");
}

}  // namespace
}  // namespace exitance
