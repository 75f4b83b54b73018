/* ceres_least_squares.cc - C interface to the Ceres solver. */
#include "common/math/ceres_least_squares.h"

#include <exception>
#include <new>

#include <ceres/ceres.h>

namespace
{

struct functor {
    const struct least_squares *problem;
    bool operator()(double const *const *x, double *residuals) const
    {
        problem->evaluate(problem->ctx, x[0], residuals);
        return true;
    }
};

} // namespace

enum status ceres_least_squares(const struct least_squares *problem, double *x, struct err *err)
{
    try {
        auto *cost = new ceres::DynamicNumericDiffCostFunction<functor>(new functor{problem});
        cost->AddParameterBlock(problem->unknowns);
        cost->SetNumResiduals(problem->residuals);

        ceres::Problem ceres_problem;
        ceres_problem.AddResidualBlock(cost, nullptr, x);
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::DENSE_QR;
        options.max_num_iterations = problem->iterations;
        options.num_threads = 1;
        options.logging_type = ceres::SILENT;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &ceres_problem, &summary);
        if (summary.IsSolutionUsable()) return ST_OK;
        return err_set(err, ST_DATA, "the least-squares solver failed: %s", summary.message.c_str());
    } catch (const std::bad_alloc &) {
        return err_nomem(err, "a least-squares problem", 0);
    } catch (const std::exception &e) {
        return err_set(err, ST_INTERNAL, "the least-squares solver failed: %s", e.what());
    }
}
