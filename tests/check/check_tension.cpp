// Every row solved three times: cold, warm from the row before, and from a guess that is wrong on purpose. Each answer
// is compared with the reference optimum and its own KKT residual is taken in quad precision.
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "check/checks.h"
#include "check/csv_reader.h"
#include "core/tension/tension_solver.h"
#include "support/exact_optimum.h"

namespace spidar::check {

namespace {

constexpr double kTensionTolerance_n = 1e-8;
constexpr double kObjectiveTolerance = 1e-12;
// A projected gradient of this size moves no string by more than the tension tolerance, unless A is nearly
// singular; then the tensions themselves decide.
constexpr double kKktTolerance_n = 1e-8;
// The reference errors e_* follow from the tensions through columns of A no longer than about 1.
constexpr double kErrorTolerance_n = 8.0 * kTensionTolerance_n;

constexpr auto kStrings = static_cast<std::size_t>(kStringCount);
constexpr auto kDofs = static_cast<std::size_t>(kDofCount);

constexpr std::array<const char *, kDofs> kDofNames{"fx", "fy", "fz", "mx", "my", "mz", "g"};

struct Row {
    std::string id;
    std::string kind;
    TensionProblem problem;
    StringArray tensions_n{};
    PaperWrench error{};
    double objective = 0.0;
};

class RowReader {
public:
    explicit RowReader(const char *path) : path_(path), table_(path) {
        for (const char *name : {"id", "kind", "obj", "wres", "active"}) {
            (void)table_.column(name);
        }
    }

    [[nodiscard]] std::size_t row_count() const { return table_.row_count(); }

    [[nodiscard]] Row read(std::size_t row) const {
        const auto value = [&](const std::string &name) {
            return table_.number(row, table_.column(name));
        };
        const auto vector = [&](const std::string &prefix) {
            return Vec3(value(prefix + "x"), value(prefix + "y"), value(prefix + "z"));
        };
        Row result;
        result.id = table_.text(row, table_.column("id"));
        result.kind = table_.text(row, table_.column("kind"));
        GripPose pose;
        pose.position_m = vector("");
        pose.r1_m = vector("r1");
        pose.r2_m = vector("r2");
        TensionProblem &p = result.problem;
        p.matrix = wrench_matrix(make_box_frame(Vec3(kPaperHalfExtent_m)), GripGeometry{}, pose);
        const double force = value("w_force");
        const double moment = value("w_moment");
        p.weights = {force, force, force, moment, moment, moment, value("w_grasp")};
        p.proximal_weight = value("eps");
        const double lower = value("tau_min");
        const double upper = value("tau_max");
        const double reference = value("tau_ref");
        const double mask = value("dead_mask");
        require(mask >= 0.0 && mask <= 255.0 && mask == std::floor(mask), result.id, "dead_mask",
                mask, "give a whole number from 0 to 255");
        require(p.proximal_weight > 0.0, result.id, "eps", p.proximal_weight, "give more than 0");
        require(lower <= upper, result.id, "tau_min", lower, "give at most tau_max");
        for (std::size_t k = 0; k < kDofs; ++k) {
            p.wrench[k] = value(kDofNames[k]);
            result.error[k] = value(std::string("e_") + kDofNames[k]);
        }
        for (std::size_t i = 0; i < kStrings; ++i) {
            const bool dead = ((static_cast<unsigned>(mask) >> i) & 1U) != 0U;
            p.lower_n[i] = dead ? 0.0 : lower;
            p.upper_n[i] = dead ? 0.0 : upper;
            p.proximal_target_n[i] = dead ? 0.0 : reference;
            result.tensions_n[i] = value("tau" + std::to_string(i + 1));
        }
        result.objective = value("obj");
        return result;
    }

private:
    void require(bool holds, const std::string &id, const char *column, double value,
                 const char *remedy) const {
        if (!holds) {
            throw CsvError(path_ + ": row id " + id + ": column '" + column + "' is " +
                           std::to_string(value) + ": " + remedy + ".");
        }
    }

    std::string path_;
    CsvTable table_;
};

// The largest of some figure, and the row that gave it. NaN counts as infinite.
struct Worst {
    double value = 0.0;
    std::string id = "-";

    void include(double candidate, const std::string &row_id) {
        if (!(candidate <= value)) {
            value = std::isnan(candidate) ? HUGE_VAL : candidate;
            id = row_id;
        }
    }
};

struct KindReport {
    long rows = 0;
    long failures = 0;
    Worst tension_n;
    Worst objective;
    Worst kkt_n;
    Worst wrench_n;
    Worst factorisations;
};

// Relative, once the rounding of the tensions themselves is taken off (it counts where the optimum is near zero).
double objective_error(const Row &row, double objective, const StringArray &tensions_n) {
    const double excess = std::abs(objective - row.objective) -
                          static_cast<double>(test::exact::rounding_cost(row.problem, tensions_n));
    return excess > 0.0 ? excess / row.objective : 0.0;
}

bool check_solution(const Row &row, const TensionSolution &solution, const char *start,
                    KindReport &report) {
    const StringArray &tau = solution.tensions_n;
    double tension_error = 0.0;
    bool in_bounds = true;
    for (std::size_t i = 0; i < kStrings; ++i) {
        tension_error = std::fmax(tension_error, std::abs(tau[i] - row.tensions_n[i]));
        in_bounds =
            in_bounds && tau[i] >= row.problem.lower_n[i] && tau[i] <= row.problem.upper_n[i];
    }
    const PaperWrench achieved = spidar::apply(row.problem.matrix, tau);
    double wrench_error = 0.0;
    for (std::size_t k = 0; k < kDofs; ++k) {
        const double error = achieved[k] - row.problem.wrench[k];
        wrench_error = std::fmax(wrench_error, std::abs(error - row.error[k]));
    }
    const auto exact_objective =
        static_cast<double>(test::exact::objective_of(row.problem, test::exact::widened(tau)));
    const double objective = objective_error(row, exact_objective, tau);
    const double kkt = test::kkt_residual_n(row.problem, tau);
    report.tension_n.include(tension_error, row.id);
    report.objective.include(objective, row.id);
    report.kkt_n.include(kkt, row.id);
    report.wrench_n.include(wrench_error, row.id);
    report.factorisations.include(solution.iterations, row.id);
    if (solution.status == Status::ok && in_bounds && tension_error <= kTensionTolerance_n &&
        objective <= kObjectiveTolerance && kkt <= kKktTolerance_n &&
        wrench_error <= kErrorTolerance_n) {
        return true;
    }
    std::printf("row id %s (%s, %s): %s tau error %.3g N, objective error %.3g, KKT %.3g N, "
                "wrench error %.3g, %s\n",
                row.id.c_str(), row.kind.c_str(), start, describe(solution.status), tension_error,
                objective, kkt, wrench_error, in_bounds ? "in bounds" : "OUT OF BOUNDS");
    return false;
}

// Every string at the bound where it is not.
ActiveSet wrong_guess(const ActiveSet &right) {
    ActiveSet wrong = right;
    for (StringBound &bound : wrong) {
        bound = bound == StringBound::at_lower ? StringBound::at_upper : StringBound::at_lower;
    }
    return wrong;
}

} // namespace

int check_tension(const char *path) {
    const RowReader reader(path);
    std::map<std::string, KindReport> kinds;
    ActiveSet last{};
    for (std::size_t i = 0; i < reader.row_count(); ++i) {
        const Row row = reader.read(i);
        KindReport &report = kinds[row.kind];
        ++report.rows;
        const TensionSolution cold = solve_tension_problem(row.problem, nullptr);
        const ActiveSet wrong = wrong_guess(cold.active);
        const bool cold_good = check_solution(row, cold, "cold", report);
        const bool warm_good =
            check_solution(row, solve_tension_problem(row.problem, &last), "warm", report);
        const bool misled_good =
            check_solution(row, solve_tension_problem(row.problem, &wrong), "misled", report);
        report.failures += cold_good && warm_good && misled_good ? 0 : 1;
        last = cold.active;
    }

    long failures = 0;
    std::printf("%-16s %6s %8s  %-20s %-20s %-20s %s\n", "kind", "rows", "failed",
                "worst tau N (id)", "objective (id)", "KKT N (id)", "factorisations (id)");
    const auto figure = [](const Worst &worst) {
        char text[64];
        std::snprintf(text, sizeof text, "%.3g (%s)", worst.value, worst.id.c_str());
        return std::string(text);
    };
    for (const auto &[kind, report] : kinds) {
        failures += report.failures;
        std::printf("%-16s %6ld %8ld  %-20s %-20s %-20s %s\n", kind.c_str(), report.rows,
                    report.failures, figure(report.tension_n).c_str(),
                    figure(report.objective).c_str(), figure(report.kkt_n).c_str(),
                    figure(report.factorisations).c_str());
    }
    std::printf("rows %zu (each cold, warm and misled), failures %ld\n", reader.row_count(),
                failures);
    if (reader.row_count() == 0) {
        std::fprintf(stderr, "spidar_check: %s has no rows; nothing was checked.\n", path);
        return 1;
    }
    return failures == 0 ? 0 : 1;
}

} // namespace spidar::check
