#include "exitance/lab/study/study_items.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace exitance {
namespace {

TEST(StudyItems, TakeTheirJudgementFromTheConclusionsOfTheirStudy) {
    StudyConclusion holds, fails;
    holds.says = "Lists hold a quarter", fails.says = "Lists by shafts are short";
    StudyReport report;
    report.verdicts.push_back({.conclusion = &holds, .holds = Verdict::Holds::yes, .detail = "0.3 (at most 0.5)"});
    report.verdicts.push_back({.conclusion = &fails, .holds = Verdict::Holds::no, .detail = "0.7 (at most 0.5)"});
    const auto both = rows_of_item({"table", "candidates", "Lists", ""}, &report);
    ASSERT_TRUE(both);
    ASSERT_EQ(both->rows.size(), 2u);
    EXPECT_EQ(both->text(0, "judgement"), "holds");
    EXPECT_EQ(both->text(1, "judgement"), "does not hold");
    EXPECT_EQ(both->text(1, "measured"), "0.7 (at most 0.5)");
    EXPECT_EQ(both->text(1, "command"), "exitance experiment candidates -o candidates");
}

TEST(StudyItems, WithoutAStudyTheyAreNotMade) {
    const auto rows = rows_of_item({"table", "", "", "nothing counts wedges"}, nullptr);
    ASSERT_TRUE(rows);
    EXPECT_EQ(rows->text(0, "judgement"), "not made");
    EXPECT_EQ(rows->text(0, "reason"), "nothing counts wedges");
}

TEST(StudyItems, AnItemWhoseConclusionIsMissingIsAnError) {
    const StudyReport report;
    const auto rows = rows_of_item({"table", "candidates", "Lists", ""}, &report);
    ASSERT_FALSE(rows);
    EXPECT_EQ(rows.error().code, ErrorCode::bad_input);
}

TEST(StudyItems, EveryBuiltInItemHasItsStudyAndConclusion) {
    const auto study_named = [](const std::string& name) -> std::optional<Study> {
        for (const BuiltInStudy& built : built_in_studies())
            if (built.name == name)
                if (Result<Study> study = parse_study(std::string(built.text), name, name)) return *study;
        return {};
    };
    const std::optional<Study> thesis = study_named("thesis");
    ASSERT_TRUE(thesis);
    EXPECT_GE(thesis->items.size(), 10u);
    for (const StudyItem& item : thesis->items) {
        if (item.study.empty()) continue;
        const std::optional<Study> study = study_named(item.study);
        ASSERT_TRUE(study) << item.study;
        const bool is_known = std::any_of(study->conclusions.begin(), study->conclusions.end(),
                                          [&](const StudyConclusion& c) { return c.says.starts_with(item.says); });
        EXPECT_TRUE(item.says.empty() || is_known) << item.shows;
        EXPECT_FALSE(item.says.empty() && item.reason.empty()) << item.shows;
    }
}

}  // namespace
}  // namespace exitance
