#include "exitance/cli/classical_arguments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

namespace exitance {
namespace {

/// A number with nothing behind it; none else.
std::optional<double> number_in(const std::string& word) {
    double value = 0;
    const char* const end = word.data() + word.size();
    const auto [at, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || at != end || !std::isfinite(value)) return {};
    return value;
}

template <class Table>
std::string names_of(const Table& table, const char* between) {
    std::vector<std::string_view> names;
    for (const auto& entry : table) names.push_back(entry.second);
    return fmt::format("{}", fmt::join(names, between));
}

template <class Table, class Target>
bool choose(const Table& table, const std::string& word, Target& target) {
    for (const auto& [value, name] : table)
        if (name == word) return target = value, true;
    return false;
}

/// An option whose values are the names of a table.
template <class Table, class Member>
ClassicalArgument choice(const char* name, const Table& table, Member member, const char* help) {
    const auto read = [&table, member](const std::string& word, SolveArguments& a) -> std::string {
        if (choose(table, word, a.classical.*member)) return "";
        return fmt::format("'{}' is not one of {}", word, names_of(table, ", "));
    };
    return {name, names_of(table, "|"), "Classical forms", help, read};
}

ClassicalArgument onoff(const char* name, std::optional<bool> ClassicalOptions::*member, const char* help) {
    const auto read = [member](const std::string& word, SolveArguments& a) -> std::string {
        if (word != "on" && word != "off") return fmt::format("must be on or off, not '{}'", word);
        a.classical.*member = word == "on";
        return "";
    };
    return {name, "on|off", "Classical forms", help, read};
}

/// A number above 0 and below `most`.
ClassicalArgument positive(const char* name, const char* unit, std::optional<double> ClassicalOptions::*member,
                           const char* help, double most = HUGE_VAL) {
    const auto read = [member, most](const std::string& word, SolveArguments& a) -> std::string {
        const std::optional<double> value = number_in(word);
        if (!value) return fmt::format("'{}' is not a number", word);
        if (!(*value > 0 && *value < most))
            return most < HUGE_VAL ? fmt::format("must be above 0 and below {}, not {}", most, word)
                                   : fmt::format("must be above 0, not {}", word);
        a.classical.*member = *value;
        return "";
    };
    return {name, unit, "Classical forms", help, read};
}

std::string read_multigrid(const std::string& word, SolveArguments& a) {
    constexpr double most = 40;
    if (word == "off") return a.classical.multigrid.reset(), "";
    const std::optional<double> value = number_in(word);
    if (!value || *value != std::floor(*value) || *value < 1 || *value > most)
        return fmt::format("must be 'off' or a whole number from 1 to {}, not '{}'", most, word);
    a.classical.multigrid = static_cast<std::size_t>(*value);
    return "";
}

/// "rounds", "shots=100,1000", "t=0.5,1,2"
std::string read_snapshots(const std::string& word, SolveArguments& a) {
    if (word == "rounds") return a.classical.snapshots.rounds = true, "";
    const bool shots = word.starts_with("shots="), times = word.starts_with("t=");
    const std::string wrong = fmt::format("'{}' is not 'rounds', 'shots=N,...' or 't=SECONDS,...'", word);
    if (!shots && !times) return wrong;
    std::string rest = word.substr(word.find('=') + 1);
    while (!rest.empty()) {
        const std::size_t comma = std::min(rest.find(','), rest.size());
        const std::optional<double> value = number_in(rest.substr(0, comma));
        if (!value || !(*value > 0) || *value > 1e15 || (shots && *value != std::floor(*value))) return wrong;
        if (shots)
            a.classical.snapshots.shots.push_back(static_cast<std::size_t>(*value));
        else
            a.classical.snapshots.seconds.push_back(*value);
        rest.erase(0, comma + 1);
    }
    return a.classical.snapshots.any() ? "" : wrong;
}

/// The relaxations of SolveOptions, and those of classical forms alone.
std::string read_relaxation(const std::string& word, SolveArguments& a) {
    a.classical.relaxation.reset(), a.options.relaxation.reset();
    if (choose(relaxation_names, word, a.options.relaxation)) return "";
    if (choose(classical_relaxation_names, word, a.classical.relaxation)) return "";
    return fmt::format("'{}' is not one of {}, {}", word, names_of(relaxation_names, ", "),
                       names_of(classical_relaxation_names, ", "));
}

std::string read_form_factors(const std::string& word, SolveArguments& a) {
    a.classical.receivers.reset(), a.options.form_factors.reset();
    if (choose(form_factor_names, word, a.options.form_factors)) return "";
    if (choose(shooting_receiver_names, word, a.classical.receivers)) return "";
    return fmt::format("'{}' is not one of {}, {}", word, names_of(form_factor_names, ", "),
                       names_of(shooting_receiver_names, ", "));
}

std::vector<ClassicalArgument> make_table() {
    using O = ClassicalOptions;
    const std::string relaxations = names_of(relaxation_names, "|") + "|" + names_of(classical_relaxation_names, "|");
    const std::string factors = names_of(form_factor_names, "|") + "|" + names_of(shooting_receiver_names, "|");
    return {
        {"--relaxation", relaxations, "Method", "How the system is solved; sor and direct: classical forms",
         read_relaxation},
        {"--form-factors", factors, "Method",
         "Where a method has the choice; vertex, middle: of receivers of shots, classical forms", read_form_factors},
        choice("--direct", classical_direct_names, &O::direct,
               "Emitters' light exact and apart, or through the method's own transport"),
        choice("--mesh", mesh_kind_names, &O::mesh,
               "Elements that follow contacts, edges and shadows, or by --mesh-size alone"),
        onoff("--gather", &O::gather, "The final gather; default on"),
        onoff("--certify", &O::certify, "off: one attempt, no estimate of the error"),
        positive("--threshold", "X", &O::threshold, "F_eps of --oracle ff, or BF_eps (W) of bf"),
        {"--multigrid", "N|off", "Classical forms", "Rounds of links, the threshold halved from one to the next",
         read_multigrid},
        choice("--kernel", transfer_kernel_names, &O::kernel, "Transfers of links: point to point, disc, or exact"),
        positive("--refine-gradient", "G", &O::refine_gradient,
                 "Substructuring: most that radiosity changes across an element, W/m^2"),
        choice("--refine", refine_when_names, &O::refine, "While light is shot (default), or after"),
        positive("--sor-factor", "W", &O::sor_factor, "Of over-relaxation; default 1.15", 2),
        {"--ambient", "", "Classical forms", "Add an estimate of what is unshot, for display",
         [](const std::string&, SolveArguments& a) { return a.classical.ambient = true, std::string(); }},
        {"--snapshots", "WHEN", "Classical forms",
         "Solutions on the way, S.0001.h5 and so on: t=0.5,1 (seconds), shots=10,100, or rounds", read_snapshots},
    };
}

}  // namespace

std::span<const ClassicalArgument> classical_arguments() {
    static const std::vector<ClassicalArgument> table = make_table();
    return table;
}

}  // namespace exitance
