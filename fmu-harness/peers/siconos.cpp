// The slider with play in its guide in Siconos: rigid impacts with Newton's restitution and Coulomb friction at the four
// corners, Moreau and Jean's time stepping.
//
//   siconos moreau SCENE SPAN POINTS STEP...
//
// One line of JSON for each step, as from sundials.c. Coordinates are the angles of crank, rod and slider; their kinetic
// energy has the mass matrix below, whose only coupling is k cos(crank - rod).
extern "C" {
#include "equations.h"
}
#include <Friction_cst.h>
#include <SiconosKernel.hpp>
#include <SolverOptions.h>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <vector>

namespace {

struct Machine {
    double crank, rod, half_length, half_height, play, height;
    double inertia[3], k, weight[2];
    double restitution, friction;
} machine;

const double THETA = 0.5; // of the midpoint rule
const double ACCURACY = 1e-10; // of Newton's iteration and of the friction solver
const int ITERATIONS = 10000;
const int FEWEST_RUNS = 2, MOST_RUNS = 50;
const double ENOUGH = 0.2; // [s]

Machine read(const char *scene) {
    auto value = [scene](const char *name) { return equations_parameter(scene, name); };
    const double r = value("crank.length"), l = value("rod.length");
    const double m1 = value("crank.mass"), m2 = value("rod.mass"), m3 = value("slider.mass");
    const double s1 = value("crank.com.x"), s2 = value("rod.com.x"), g = value("gravity");
    Machine all = {};
    all.crank = r;
    all.rod = l;
    all.half_length = 0.5 * value("slider.length");
    all.half_height = 0.5 * value("slider.height");
    all.play = value("joint.T.clearance");
    all.height = value("guide.offset");
    all.inertia[0] = value("crank.inertia") + m1 * s1 * s1 + (m2 + m3) * r * r;
    all.inertia[1] = value("rod.inertia") + m2 * s2 * s2 + m3 * l * l;
    all.inertia[2] = value("slider.inertia");
    all.k = (m2 * s2 + m3 * l) * r;
    all.weight[0] = (m1 * s1 + (m2 + m3) * r) * g;
    all.weight[1] = (m2 * s2 + m3 * l) * g;
    all.restitution = value("joint.T.restitution");
    all.friction = value("joint.T.friction.coefficient");
    return all;
}

// Matrices are stored column by column.
void mass(unsigned, double *q, double *m, unsigned, double *) {
    const double coupling = machine.k * std::cos(q[0] - q[1]);
    const double all[9] = {machine.inertia[0], coupling, 0, coupling, machine.inertia[1], 0, 0, 0, machine.inertia[2]};
    std::copy(all, all + 9, m);
}

void gyroscopic(unsigned, double *q, double *v, double *f, unsigned, double *) {
    const double s = machine.k * std::sin(q[0] - q[1]);
    f[0] = s * v[1] * v[1];
    f[1] = -s * v[0] * v[0];
    f[2] = 0;
}

void gyroscopic_by_position(unsigned, double *q, double *v, double *j, unsigned, double *) {
    const double c = machine.k * std::cos(q[0] - q[1]);
    const double a = c * v[1] * v[1], b = c * v[0] * v[0];
    const double all[9] = {a, -b, 0, -a, b, 0, 0, 0, 0};
    std::copy(all, all + 9, j);
}

void gyroscopic_by_velocity(unsigned, double *q, double *v, double *j, unsigned, double *) {
    const double s = machine.k * std::sin(q[0] - q[1]);
    const double all[9] = {0, -2 * s * v[0], 0, 2 * s * v[1], 0, 0, 0, 0, 0};
    std::copy(all, all + 9, j);
}

void gravity(double, unsigned, double *q, double *, double *f, unsigned, double *) {
    f[0] = machine.weight[0] * std::cos(q[0]);
    f[1] = machine.weight[1] * std::cos(q[1]);
    f[2] = 0;
}

void gravity_by_position(double, unsigned, double *q, double *, double *j, unsigned, double *) {
    std::fill(j, j + 9, 0.0);
    j[0] = -machine.weight[0] * std::sin(q[0]);
    j[4] = -machine.weight[1] * std::sin(q[1]);
}

void nothing(double, unsigned, double *, double *, double *j, unsigned, double *) {
    std::fill(j, j + 9, 0.0);
}

// A corner at (along half_length, across half_height) from the slider's middle, against the line on its side.
class Corner : public LagrangianScleronomousR {
  public:
    Corner(double along, double across) : along_(along), across_(across) {}

    void computeh(const BlockVector &q, BlockVector &, SiconosVector &y) override {
        const double a = along_ * machine.half_length, b = across_ * machine.half_height;
        const double pin = machine.crank * std::sin(q(0)) + machine.rod * std::sin(q(1)) - machine.height;
        const double corner = pin + a * std::sin(q(2)) + b * std::cos(q(2));
        y.setValue(0, machine.half_height + machine.play - across_ * corner);
        y.setValue(1, 0.0);
    }

    void computeJachq(const BlockVector &q, BlockVector &) override {
        const double a = along_ * machine.half_length, b = across_ * machine.half_height;
        const double arm[3] = {machine.crank, machine.rod, a};
        for (unsigned i = 0; i < 3; i++) {
            const double turned = i == 2 ? b : 0.0;
            const double s = std::sin(q(i)), c = std::cos(q(i));
            _jachq->setValue(0, i, -across_ * (arm[i] * c - turned * s));
            _jachq->setValue(1, i, -arm[i] * s - turned * c);
        }
    }

  private:
    double along_, across_;
};

double cpu_time() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// Angles at the points if there is room for them; the CPU time of the steps.
double march(const double *start, double span, int points, long steps, std::vector<double> *angles) {
    SP::SiconosVector q(new SiconosVector(3)), v(new SiconosVector(3));
    for (unsigned i = 0; i < 3; i++) {
        q->setValue(i, start[i]);
        v->setValue(i, start[3 + i]);
    }
    SP::LagrangianDS body(new LagrangianDS(q, v));
    body->setComputeMassFunction(mass);
    body->setComputeFGyrFunction(gyroscopic);
    body->setComputeJacobianFGyrqFunction(gyroscopic_by_position);
    body->setComputeJacobianFGyrqDotFunction(gyroscopic_by_velocity);
    body->setComputeFIntFunction(gravity);
    body->setComputeJacobianFIntqFunction(gravity_by_position);
    body->setComputeJacobianFIntqDotFunction(nothing);
    const double h = span / double(steps);
    SP::NonSmoothDynamicalSystem system(new NonSmoothDynamicalSystem(0.0, span * (1 + 1e-9)));
    system->insertDynamicalSystem(body);
    for (double across : {1.0, -1.0}) {
        for (double along : {-1.0, 1.0}) {
            SP::NonSmoothLaw law(new NewtonImpactFrictionNSL(machine.restitution, 0.0, machine.friction, 2));
            SP::Relation relation(new Corner(along, across));
            system->link(SP::Interaction(new Interaction(law, relation)), body);
        }
    }
    SP::TimeDiscretisation clock(new TimeDiscretisation(0.0, h));
    SP::OneStepIntegrator rule(new MoreauJeanOSI(THETA));
    SP::FrictionContact contact(new FrictionContact(2, SICONOS_FRICTION_2D_LEMKE));
    contact->numericsSolverOptions()->dparam[SICONOS_DPARAM_TOL] = ACCURACY;
    contact->numericsSolverOptions()->iparam[SICONOS_IPARAM_MAX_ITER] = ITERATIONS;
    SP::TimeStepping stepping(new TimeStepping(system, clock, rule, contact));
    stepping->setNewtonTolerance(ACCURACY);
    stepping->initialize();
    const long every = steps / points;
    const double before = cpu_time();
    for (long step = 1; step <= steps && stepping->hasNextEvent(); step++) {
        stepping->computeOneStep();
        if (angles && step % every == 0)
            for (unsigned i = 0; i < 3; i++) angles->push_back(body->q()->getValue(i));
        stepping->nextStep();
    }
    return cpu_time() - before;
}

void report(const double *start, double span, int points, double step) {
    // Siconos writes to standard output too: a line of ours is printed as a whole.
    try {
        const long steps = points * std::lround(span / points / step);
        std::vector<double> angles;
        double least = march(start, span, points, steps, &angles), total = 0.0;
        for (int i = 0; i < MOST_RUNS && (i < FEWEST_RUNS || total < ENOUGH); i++) {
            const double seconds = march(start, span, points, steps, nullptr);
            least = std::min(least, seconds);
            total += seconds;
        }
        std::printf("{\"tolerance\": %.17g, \"seconds\": %.9g, \"evaluations\": %ld, \"positions\": [", step, least, steps);
        for (size_t i = 0; i < angles.size(); i++) std::printf("%s%.17g", i ? ", " : "", angles[i]);
        std::printf("]}\n");
    } catch (const std::exception &error) {
        std::printf("{\"tolerance\": %.17g, \"note\": \"gave up\"}\n", step);
        std::fprintf(stderr, "%s\n", error.what());
    }
    std::fflush(stdout);
}

} // namespace

int main(int count, char **words) {
    if (count < 6) {
        std::fprintf(stderr, "usage: %s moreau SCENE SPAN POINTS STEP...\n", words[0]);
        return 2;
    }
    system_of_equations *equations = equations_open(words[2]);
    if (!equations || equations_positions(equations) != 3) return 1;
    double start[6];
    equations_start(equations, start);
    equations_close(equations);
    machine = read(words[2]);
    const double span = std::atof(words[3]);
    for (int i = 5; i < count; i++) report(start, span, std::atoi(words[4]), std::atof(words[i]));
    return 0;
}
