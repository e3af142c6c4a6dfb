// Writes the dynamics of a URDF as C, by Pinocchio's algorithms over CasADi's symbols.
//
//     casadi_generator ROBOT.urdf fixed|floating FOLDER FUNCTION...
//
// FUNCTION is one of equations, equations_dense, mass_matrix, bias, inverse_dynamics, forward_dynamics,
// inverse_dynamics_derivatives, forward_dynamics_derivatives (CasADi's Jacobians by q, v and a or u), and the
// same with _world: Pinocchio's other convention, all frames in the axes of the world.
// FOLDER/FUNCTION.c is written for each. Printed is JSON: the CPU seconds of reading the robot, the names
// of its joints in Pinocchio's order, and of each function the operation codes it counts and its CPU seconds.

#include <pinocchio/autodiff/casadi.hpp>

#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <pinocchio/parsers/urdf.hpp>

#include <ctime>
#include <iostream>
#include <map>
#include <string>
#include <vector>

using casadi::SX;
using SymbolicModel = pinocchio::ModelTpl<SX>;
using SymbolicData = pinocchio::DataTpl<SX>;
using Vector = Eigen::Matrix<SX, Eigen::Dynamic, 1>;

static double cpu_seconds()
{
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

static Vector over_eigen(const SX &symbols)
{
    Vector result(symbols.numel());
    for (casadi_int k = 0; k < symbols.numel(); ++k) {
        result[k] = symbols(k);
    }
    return result;
}

static SX over_casadi(const Vector &values)
{
    SX result = SX::zeros(values.size());
    for (Eigen::Index k = 0; k < values.size(); ++k) {
        result(k) = values[k];
    }
    return result;
}

// crba fills the upper triangle only.
static SX mass_matrix(const SymbolicModel &model, SymbolicData &data, const Vector &q,
                      pinocchio::Convention convention)
{
    pinocchio::crba(model, data, q, convention);
    SX M(model.nv, model.nv);
    for (int i = 0; i < model.nv; ++i) {
        for (int j = i; j < model.nv; ++j) {
            M(i, j) = data.M(i, j);
        }
    }
    return sparsify(M);
}

static casadi::Function function(const SymbolicModel &model, const std::string &name,
                                 const std::string &kind, pinocchio::Convention convention)
{
    SymbolicData data(model);
    const SX q = SX::sym("q", model.nq), v = SX::sym("v", model.nv), a = SX::sym("a", model.nv);
    const Vector q_ = over_eigen(q), v_ = over_eigen(v), a_ = over_eigen(a);
    std::vector<SX> in{q}, out;
    if (kind == "equations" || kind == "equations_dense" || kind == "mass_matrix") {
        const SX M = mass_matrix(model, data, q_, convention);
        out.push_back(kind == "equations_dense" ? densify(triu2symm(M)) : M);
    }
    if (kind == "equations" || kind == "equations_dense" || kind == "bias") {
        in.push_back(v);
        out.push_back(over_casadi(pinocchio::nonLinearEffects(model, data, q_, v_)));
    }
    if (kind == "inverse_dynamics" || kind == "inverse_dynamics_derivatives") {
        in.insert(in.end(), {v, a});
        out.push_back(over_casadi(pinocchio::rnea(model, data, q_, v_, a_)));
    }
    if (kind == "forward_dynamics" || kind == "forward_dynamics_derivatives") { // a floating base has no motor: its efforts are zeros
        const int free = model.joints[1].nv() == 6 ? 6 : 0;
        const SX u = SX::sym("u", model.nv - free);
        const Vector tau = over_eigen(vertcat(SX::zeros(free), u));
        in.insert(in.end(), {v, u});
        out.push_back(over_casadi(pinocchio::aba(model, data, q_, v_, tau, convention)));
    }
    if (out.empty()) {
        throw std::invalid_argument("no function " + kind);
    }
    if (kind.find("_derivatives") != std::string::npos) {
        const SX whole = out.front();
        out.clear();
        for (const SX &by : in) {
            out.push_back(jacobian(whole, by));
        }
    }
    return casadi::Function(name, in, out, {{"cse", true}});
}

static void report(const casadi::Function &made, double seconds)
{
    std::map<casadi_int, int> codes;
    for (casadi_int k = 0; k < made.n_instructions(); ++k) {
        ++codes[made.instruction_id(k)];
    }
    std::cout << "{\"seconds\": " << seconds << ", \"codes\": {";
    const char *comma = "";
    for (const auto &[code, count] : codes) {
        std::cout << comma << '"' << code << "\": " << count;
        comma = ", ";
    }
    std::cout << "}}";
}

static void generate(const SymbolicModel &model, const std::string &folder, const std::string &name)
{
    const std::string mark = "_world";
    const bool world = name.size() > mark.size()
        && name.compare(name.size() - mark.size(), mark.size(), mark) == 0;
    const double start = cpu_seconds();
    const casadi::Function made =
        function(model, name, world ? name.substr(0, name.size() - mark.size()) : name,
                 world ? pinocchio::Convention::WORLD : pinocchio::Convention::LOCAL);
    casadi::CodeGenerator file(name + ".c", casadi::Dict());
    file.add(made);
    file.generate(folder + "/");
    report(made, cpu_seconds() - start);
}

int main(int count, char **words)
{
    if (count < 5) {
        std::cerr << "casadi_generator ROBOT.urdf fixed|floating FOLDER FUNCTION...\n";
        return 2;
    }
    const double start = cpu_seconds();
    pinocchio::Model read;
    if (std::string(words[2]) == "floating") {
        pinocchio::urdf::buildModel(words[1], pinocchio::JointModelFreeFlyer(), "root", read);
    } else {
        pinocchio::urdf::buildModel(words[1], read);
    }
    const SymbolicModel model = read.cast<SX>();
    std::cout << "{\"seconds\": " << cpu_seconds() - start << ", \"nq\": " << model.nq
              << ", \"nv\": " << model.nv << ", \"joints\": [";
    for (std::size_t k = 1; k < model.names.size(); ++k) {
        std::cout << (k > 1 ? ", " : "") << '"' << model.names[k] << '"';
    }
    std::cout << "], \"functions\": {";
    for (int k = 4; k < count; ++k) {
        std::cout << (k > 4 ? ", " : "") << '"' << words[k] << "\": ";
        generate(model, words[3], words[k]);
    }
    std::cout << "}}\n";
    return 0;
}
