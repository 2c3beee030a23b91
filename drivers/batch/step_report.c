/* SPDX-License-Identifier: BSD-3-Clause */
/* What the log says of steps, before a run and after it. */
#include "step_report.h"

#include <math.h>

#include "ask.h"

dem_method_traits step_report_method(const dem_simulation *simulation)
{
    dem_method_traits traits = {.struct_size = sizeof traits};
    (void)dem_method_describe(&traits, ask_options(simulation).method);
    return traits;
}

/* |R| - 1 of the oscillation that grows most, of those up to omega h. */
static double largest_growth(dem_method method, double omega_h)
{
    enum { samples = 100 };
    double largest = 0.0;
    for (int k = 1; k <= samples; k++) largest = fmax(largest, dem_method_growth(method, omega_h * k / samples) - 1.0);
    return largest;
}

/* What the step is in units of the fastest oscillation, and what the method makes of that. */
static void print_stability(FILE *out, const dem_method_traits *method, const dem_options *o, double omega)
{
    const double z = omega * o->max_step;
    if (!(omega > 0.0)) return;
    (void)fprintf(out, "stability  omega_max h = %.3g; ", z);
    if (method->stable > 0.0)
        (void)fprintf(out, "%s is stable up to %.3g, h = %.4g s\n", method->name, method->stable,
                      method->stable / omega);
    else
        (void)fprintf(out, "with %s undamped oscillations grow at any step, here by up to %.1e in one\n", method->name,
                      largest_growth(o->method, z));
}

void step_report_print(FILE *out, const char *until, double steps, double undamped, const dem_simulation *simulation)
{
    const dem_options o = ask_options(simulation);
    const dem_method_traits method = step_report_method(simulation);
    const double omega = dem_model_omega_max(dem_simulation_model(simulation));
    (void)fprintf(out, "time       %s %.0f steps of %s; %s step %.4g s", until, steps, method.name,
                  o.fixed_step > 0.0 ? "fixed" : "largest", o.max_step);
    if (undamped > 0.0)
        (void)fprintf(out, " (damping shortens it from %.4g s)", undamped);
    else if (omega > 0.0)
        (void)fprintf(out, " (safe up to %.4g s)", method.usable / omega);
    (void)fprintf(out, "\n");
}

bool step_report_is_long(const dem_simulation *simulation, char *why)
{
    const dem_options o = ask_options(simulation);
    const dem_method_traits method = step_report_method(simulation);
    const double omega = dem_model_omega_max(dem_simulation_model(simulation)), safe = method.usable / omega;
    const bool is_long = o.fixed_step > 0.0 && o.fixed_step * omega > method.usable;
    why[0] = '\0';
    if (is_long)
        (void)snprintf(
            why, STEP_REPORT_WHY,
            "the fixed step of %.3g s is %.3g times the %.3g s up to which %s is safe here; give 'fixed_step' "
            "in &solver at most that, or leave it out",
            o.fixed_step, o.fixed_step / safe, safe, method.name);
    return is_long;
}

void step_report_print_details(FILE *out, const dem_simulation *simulation)
{
    const dem_options o = ask_options(simulation);
    const dem_method_traits method = step_report_method(simulation);
    (void)fprintf(out, "method     %s of order %d, %d evaluation%s a step, rtol %.3g\n", method.name, (int)method.order,
                  (int)method.evaluations, method.evaluations > 1 ? "s" : "", o.rtol);
    print_stability(out, &method, &o, dem_model_omega_max(dem_simulation_model(simulation)));
    (void)fprintf(out, "kernel     %s, %d thread%s\n", dem_kernel_name(o.kernel), (int)o.threads,
                  o.threads > 1 ? "s" : "");
    (void)fprintf(out, "formula 6  (|v_x| + |v_y|) h/spacing = %.3g at v_scale along x; it does not bound the step\n",
                  o.v_scale * o.max_step / o.spacing);
}

void step_report_follow(step_report *p, const dem_simulation *simulation, const dem_progress *now)
{
    const double value = dem_simulation_fastest(simulation) * now->step / ask_options(simulation).spacing; /* (6) */
    if (value <= p->largest) return;
    p->largest = value;
    p->t = now->t;
}

void step_report_print_largest(FILE *out, const step_report *p)
{
    (void)fprintf(out, "formula 6  (|v_x| + |v_y|) h/spacing was %.3g at most, at %.4e s\n", p->largest, p->t);
}
