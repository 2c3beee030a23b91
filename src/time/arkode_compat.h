/* SPDX-License-Identifier: BSD-3-Clause */
/* The interface of ARKODE in SUNDIALS 7, for 6.4 and later too: old names are defined as the new ones, and the
 * functions below hide what changed in kind, errors and the controller of steps. Errors go to a listener; nothing is
 * printed. */
#ifndef DEM_TIME_ARKODE_COMPAT_H
#define DEM_TIME_ARKODE_COMPAT_H

#include <stdbool.h>

#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_version.h>

/** Called with the message of every error. */
typedef void (*arkode_listener)(const char *message, void *user);

typedef struct arkode_errors {
    arkode_listener listener;
    void *user;
} arkode_errors;

#if SUNDIALS_VERSION_MAJOR >= 7

#include <sunadaptcontroller/sunadaptcontroller_soderlind.h>

typedef SUNAdaptController arkode_controller;

static inline void arkode_tell(int line, const char *function, const char *file, const char *message, SUNErrCode code,
                               void *errors, SUNContext context)
{
    const arkode_errors *e = errors;
    (void)line;
    (void)function;
    (void)file;
    (void)context;
    if (code < 0) e->listener(message != NULL ? message : SUNGetErrMsg(code), e->user);
}

/** To be called before anything is created in the context, so that all its errors reach the listener. Warnings would be
 *  printed by a logger, which this removes. */
static inline int arkode_listen_first(SUNContext context, arkode_errors *errors)
{
    int failed = SUNContext_ClearErrHandlers(context);
    failed |= SUNContext_SetLogger(context, NULL);
    failed |= SUNContext_PushErrHandler(context, arkode_tell, errors);
    return failed;
}

static inline int arkode_listen(void *memory, arkode_errors *errors)
{
    (void)memory;
    (void)errors;
    return 0;
}

static inline int arkode_use_pi(SUNContext context, void *memory, arkode_controller *out)
{
    *out = SUNAdaptController_PI(context);
    return *out == NULL ? -1 : ARKodeSetAdaptController(memory, *out);
}

static inline void arkode_free_controller(arkode_controller c)
{
    if (c != NULL) (void)SUNAdaptController_Destroy(c);
}

#else

#define SUN_COMM_NULL               NULL
#define ARKodeEvolve                ERKStepEvolve
#define ARKodeFree                  ERKStepFree
#define ARKodeGetCurrentStep        ERKStepGetCurrentStep
#define ARKodeGetCurrentTime        ERKStepGetCurrentTime
#define ARKodeGetDky                ERKStepGetDky
#define ARKodeGetEstLocalErrors     ERKStepGetEstLocalErrors
#define ARKodeGetNumErrTestFails    ERKStepGetNumErrTestFails
#define ARKodeReset                 ERKStepReset
#define ARKodeRootInit              ERKStepRootInit
#define ARKodeSetErrorBias          ERKStepSetErrorBias
#define ARKodeSetFixedStep          ERKStepSetFixedStep
#define ARKodeSetFixedStepBounds    ERKStepSetFixedStepBounds
#define ARKodeSetInitStep           ERKStepSetInitStep
#define ARKodeSetInterpolantDegree  ERKStepSetInterpolantDegree
#define ARKodeSetMaxEFailGrowth     ERKStepSetMaxEFailGrowth
#define ARKodeSetMaxErrTestFails    ERKStepSetMaxErrTestFails
#define ARKodeSetMaxFirstGrowth     ERKStepSetMaxFirstGrowth
#define ARKodeSetMaxGrowth          ERKStepSetMaxGrowth
#define ARKodeSetMaxHnilWarns       ERKStepSetMaxHnilWarns
#define ARKodeSetMaxNumSteps        ERKStepSetMaxNumSteps
#define ARKodeSetMaxStep            ERKStepSetMaxStep
#define ARKodeSetMinReduction       ERKStepSetMinReduction
#define ARKodeSetMinStep            ERKStepSetMinStep
#define ARKodeSetNoInactiveRootWarn ERKStepSetNoInactiveRootWarn
#define ARKodeSetRootDirection      ERKStepSetRootDirection
#define ARKodeSetSafetyFactor       ERKStepSetSafetyFactor
#define ARKodeSetSmallNumEFails     ERKStepSetSmallNumEFails
#define ARKodeSetUserData           ERKStepSetUserData
#define ARKodeWFtolerances          ERKStepWFtolerances

typedef void *arkode_controller;

static inline void arkode_tell(int code, const char *module, const char *function, char *message, void *errors)
{
    const arkode_errors *e = errors;
    (void)module;
    (void)function;
    if (code < 0) e->listener(message, e->user);
}

static inline int arkode_listen_first(SUNContext context, arkode_errors *errors)
{
    (void)context;
    (void)errors;
    return 0;
}

static inline int arkode_listen(void *memory, arkode_errors *errors)
{
    return ERKStepSetErrHandlerFn(memory, arkode_tell, errors);
}

static inline int arkode_use_pi(SUNContext context, void *memory, arkode_controller *out)
{
    (void)context;
    *out = NULL;
    return ERKStepSetAdaptivityMethod(memory, ARK_ADAPT_PI, 1, 0, NULL);
}

static inline void arkode_free_controller(arkode_controller c)
{
    (void)c;
}

#endif

#endif
