#pragma once

#include "exitance/cli/exit_code.hpp"
#include "exitance/cli/options/arguments.hpp"
#include "exitance/cli/terminal.hpp"

namespace exitance {

// Runs a verb. Each verb has a file of its own: verbs/NAME.cpp, for `solve` solve.cpp.

ExitCode run(const SolveArguments& arguments, Terminal& terminal);
ExitCode run(const ProbeArguments& arguments, Terminal& terminal);
ExitCode run(const LightProbeArguments& arguments, Terminal& terminal);
ExitCode run(const CompareArguments& arguments, Terminal& terminal);
ExitCode run(const StatsArguments& arguments, Terminal& terminal);
ExitCode run(const MixArguments& arguments, Terminal& terminal);
ExitCode run(const ExportArguments& arguments, Terminal& terminal);
ExitCode run(const RenderArguments& arguments, Terminal& terminal);
ExitCode run(const BakeArguments& arguments, Terminal& terminal);
ExitCode run(const ReportArguments& arguments, Terminal& terminal);
ExitCode run(const GlareArguments& arguments, Terminal& terminal);
ExitCode run(const DaylightArguments& arguments, Terminal& terminal);
ExitCode run(const CheckArguments& arguments, Terminal& terminal);
ExitCode run(const GenerateArguments& arguments, Terminal& terminal);
ExitCode run(const LuminaireArguments& arguments, Terminal& terminal);
ExitCode run(const ExperimentArguments& arguments, Terminal& terminal);
ExitCode run(const ViewFactorArguments& arguments, Terminal& terminal);
ExitCode run(const View3dArguments& arguments, Terminal& terminal);
ExitCode run(const HeatArguments& arguments, Terminal& terminal);
ExitCode run(const SweepArguments& arguments, Terminal& terminal);
ExitCode run(const ViewArguments& arguments, Terminal& terminal);
ExitCode run(const ReferenceArguments& arguments, Terminal& terminal);

}  // namespace exitance
