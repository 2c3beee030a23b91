/* SPDX-License-Identifier: BSD-3-Clause */
/** dem/method.h -- methods of integration in time, by name, and what is known of them before any step. */
#ifndef DEM_METHOD_H
#define DEM_METHOD_H

#include <dem/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How the motion is integrated. A pair of orders p(q), named by both, advances with the higher and chooses its steps
 *  by what the two differ; the methods with one order take steps of one length. */
typedef enum dem_method {
    DEM_METHOD_FEHLBERG45 = 0,
    DEM_METHOD_DOPRI45,     /**< of Dormand and Prince */
    DEM_METHOD_CASHKARP45,  /**< of Cash and Karp */
    DEM_METHOD_ZONNEVELD34, /**< of Zonneveld */
    DEM_METHOD_BS23,        /**< of Bogacki and Shampine */
    DEM_METHOD_HEUN12,      /**< Heun's method with Euler's */
    DEM_METHOD_SAYFYABURUB34,
    DEM_METHOD_ARK23, /**< the explicit halves of Kennedy and Carpenter's additive pairs: this, */
    DEM_METHOD_ARK34,
    DEM_METHOD_ARK34B,
    DEM_METHOD_ARK45,
    DEM_METHOD_ARK45B, /**< and those up to here */
    DEM_METHOD_VERNER56,
    DEM_METHOD_VERNER67, /**< in SUNDIALS from 6.7 on, */
    DEM_METHOD_VERNER78, /**< as this, */
    DEM_METHOD_VERNER89, /**< and this */
    DEM_METHOD_FEHLBERG78,
    DEM_METHOD_KNOTHWOLKE3, /**< fixed steps */
    DEM_METHOD_RK4,         /**< the classical Runge-Kutta method, fixed steps */
    DEM_METHOD_VERLET       /**< velocity Verlet, (5) with contacts located, fixed steps */
} dem_method;

/** What is known of a method before any step. Undamped oscillations of angular frequency omega are multiplied by
 *  dem_method_growth(method, omega h) in a step h. */
typedef struct dem_method_traits {
    size_t struct_size;  /**< to be set to sizeof(dem_method_traits) */
    const char *name;    /**< as in decks: "fehlberg45" */
    int32_t order;       /**< of what advances */
    int32_t evaluations; /**< of the right-hand side (4), in an accepted step without contact events */
    bool adaptive;       /**< whether it chooses its steps; else they are of one length, `fixed_step` */
    double stable;       /**< largest omega h up to which no oscillation grows; 0: each does in each step */
    double usable;       /**< largest omega h up to which none grows by more than 1e-3 in a step */
} dem_method_traits;

/** \return DEM_ERROR_ARGUMENT for an unknown method, and for one that the installed SUNDIALS does not have */
DEM_API dem_status dem_method_describe(dem_method_traits *out, dem_method method);

/** The method of a name, in this SUNDIALS or not.  \return DEM_ERROR_ARGUMENT if there is none */
DEM_API dem_status dem_method_find(dem_method *out, const char *name);

/** Modulus of the largest eigenvalue of a step h of x'' = -omega^2 x; NAN if dem_method_describe() fails. */
DEM_API double dem_method_growth(dem_method method, double omega_h);

#ifdef __cplusplus
}
#endif

#endif
