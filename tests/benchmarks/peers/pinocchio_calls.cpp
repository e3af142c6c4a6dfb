// Pinocchio's own algorithms over doubles, as a library for the harness.
//
// setup takes "FUNCTION CONVENTION MODEL.bin", FUNCTION one of equations, inverse_dynamics,
// forward_dynamics and CONVENTION one of local, world: where crba and aba express their frames. The model
// was saved by Pinocchio's Python: its library was built for an older processor, and its vectors lie in
// memory otherwise than those of what is compiled here for this one.

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/serialization.hpp>

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>

using Map = Eigen::Map<const Eigen::VectorXd>;

enum class Function { equations, inverse_dynamics, forward_dynamics };

struct Robot {
    pinocchio::Model model;
    std::unique_ptr<pinocchio::Data> data;
    Eigen::VectorXd tau;
    Function function;
    pinocchio::Convention convention;
};

extern "C" void *setup(const char *options)
{
    std::string function, convention, file;
    std::istringstream(options) >> function >> convention >> file;
    auto *robot = new Robot;
    robot->model.loadFromBinary(file);
    robot->data = std::make_unique<pinocchio::Data>(robot->model);
    robot->tau = Eigen::VectorXd::Zero(robot->model.nv);
    robot->function = function == "equations"      ? Function::equations
                      : function == "inverse_dynamics" ? Function::inverse_dynamics
                                                       : Function::forward_dynamics;
    robot->convention =
        convention == "world" ? pinocchio::Convention::WORLD : pinocchio::Convention::LOCAL;
    return robot;
}

// Names of the joints in order, one a line.
extern "C" void names(const void *self, char *text)
{
    const auto &names = static_cast<const Robot *>(self)->model.names;
    for (std::size_t k = 1; k < names.size(); ++k) {
        text = std::copy(names[k].begin(), names[k].end(), text);
        *text++ = '\n';
    }
    *text = '\0';
}

extern "C" void call(void *self, const double *x, double *)
{
    auto &[model, data, tau, function, convention] = *static_cast<Robot *>(self);
    const Map q(x, model.nq), v(x + model.nq, model.nv);
    const double *rest = x + model.nq + model.nv;
    if (function == Function::equations) {
        pinocchio::crba(model, *data, q, convention);
        pinocchio::nonLinearEffects(model, *data, q, v);
    } else if (function == Function::inverse_dynamics) {
        pinocchio::rnea(model, *data, q, v, Map(rest, model.nv));
    } else { // a floating base has no motor: its efforts stay zeros
        const int driven = model.joints[1].nv() == 6 ? model.nv - 6 : model.nv;
        tau.tail(driven) = Map(rest, driven);
        pinocchio::aba(model, *data, q, v, tau, convention);
    }
}

// The results of the last call: apart, as a user reads them where they are. crba fills a triangle.
extern "C" void fetch(void *self, double *y)
{
    const auto &[model, data, tau, function, convention] = *static_cast<Robot *>(self);
    if (function == Function::equations) {
        for (int i = 0; i < model.nv; ++i) {
            for (int j = 0; j < model.nv; ++j) {
                *y++ = i <= j ? data->M(i, j) : data->M(j, i);
            }
        }
    }
    const Eigen::VectorXd &vector = function == Function::equations          ? data->nle
                                    : function == Function::inverse_dynamics ? data->tau
                                                                             : data->ddq;
    std::copy(vector.data(), vector.data() + model.nv, y);
}
