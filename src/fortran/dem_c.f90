! SPDX-License-Identifier: BSD-3-Clause
!> The C interface of dem, name by name, written by src/fortran/bindings.py from the headers in include/dem, which tell
!> what everything does, with shapes, units, errors and ownership. Programs use the module dem, which is made of this.
module dem_c
  use, intrinsic :: iso_c_binding
  implicit none
  public

  integer, parameter :: dem_index = c_int64_t

  ! ---- dem/status.h --------------------------------------------------------------------------------------------------

  integer, parameter :: dem_status = c_int
  enum, bind(c)
    enumerator :: DEM_OK = 0, DEM_STOPPED = 1, DEM_ERROR_MEMORY = -1, DEM_ERROR_ARGUMENT = -2, DEM_ERROR_MODEL = -3
    enumerator :: DEM_ERROR_INTEGRATOR = -4, DEM_ERROR_CONTACT = -5, DEM_ERROR_IO = -6
  end enum

  interface

    type(c_ptr) function c_status_name(status) bind(c, name='dem_status_name')
      import
      integer(dem_status), value :: status
    end function

    type(c_ptr) function c_status_message() bind(c, name='dem_status_message')
      import
    end function

    type(c_ptr) function c_version() bind(c, name='dem_version')
      import
    end function

    type(c_ptr) function c_version_sundials() bind(c, name='dem_version_sundials')
      import
    end function

  end interface

  ! ---- dem/checkpoint.h ----------------------------------------------------------------------------------------------

  interface

    integer(dem_status) function dem_checkpoint_create(out) bind(c)
      import
      type(c_ptr), intent(out) :: out
    end function

    subroutine dem_checkpoint_destroy(checkpoint) bind(c)
      import
      type(c_ptr), value :: checkpoint
    end subroutine

    integer(dem_status) function dem_checkpoint_put(checkpoint, name, data, size) bind(c)
      import
      type(c_ptr), value :: checkpoint
      character(kind=c_char), intent(in) :: name(*)
      type(c_ptr), value :: data
      integer(c_size_t), value :: size
    end function

    integer(dem_status) function dem_checkpoint_get(checkpoint, name, data, size) bind(c)
      import
      type(c_ptr), value :: checkpoint
      character(kind=c_char), intent(in) :: name(*)
      type(c_ptr), value :: data
      integer(c_size_t), value :: size
    end function

    type(c_ptr) function dem_checkpoint_find(checkpoint, name, size) bind(c)
      import
      type(c_ptr), value :: checkpoint
      character(kind=c_char), intent(in) :: name(*)
      integer(c_size_t), intent(out) :: size
    end function

    integer(dem_status) function dem_checkpoint_write(checkpoint, path) bind(c)
      import
      type(c_ptr), value :: checkpoint
      character(kind=c_char), intent(in) :: path(*)
    end function

    integer(dem_status) function dem_checkpoint_read(out, path) bind(c)
      import
      type(c_ptr), intent(out) :: out
      character(kind=c_char), intent(in) :: path(*)
    end function

    integer(dem_status) function dem_publish(part, path) bind(c)
      import
      character(kind=c_char), intent(in) :: part(*), path(*)
    end function

  end interface

  ! ---- dem/lattice.h -------------------------------------------------------------------------------------------------

  integer, parameter :: dem_plane = c_int
  enum, bind(c)
    enumerator :: DEM_PLANE_STRESS = 0, DEM_PLANE_STRAIN = 1
  end enum

  integer, parameter :: dem_springs = c_int
  enum, bind(c)
    enumerator :: DEM_SPRINGS_INDEPENDENT = 0, DEM_SPRINGS_COUPLED = 1
  end enum

  integer, parameter :: dem_stress_average = c_int
  enum, bind(c)
    enumerator :: DEM_STRESS_AVERAGE_CORNERS = 0, DEM_STRESS_AVERAGE_ELEMENT = 1
  end enum

  enum, bind(c)
    enumerator :: DEM_NODE_FIXED = 1, DEM_NODE_CONTACT = 2, DEM_NODE_RIGID = 4, DEM_NODE_GUIDE_X = 8
    enumerator :: DEM_NODE_GUIDE_Y = 16
  end enum

  integer, parameter :: dem_guide = c_int
  enum, bind(c)
    enumerator :: DEM_GUIDE_NONE = 0, DEM_GUIDE_X = 1, DEM_GUIDE_Y = 2
  end enum

  type, bind(c) :: dem_material
    integer(c_size_t) :: struct_size = 120
    real(c_double) :: youngs_modulus = 0, bond_stiffness = 0, poissons_ratio = 0
    integer(dem_plane) :: plane = 0
    real(c_double) :: density = 0, thickness = 0, guard = 0, damping_time = 0
    integer(dem_springs) :: springs = 0
    real(c_double) :: strength = 0, critical_stretch = 0, fracture_energy = 0, compressive_strength = 0
    integer(dem_stress_average) :: stress_average = 0
  end type

  type, bind(c) :: dem_lattice
    integer(c_size_t) :: struct_size = 216
    integer(c_int) :: dim = 0
    integer(dem_index) :: n_nodes = 0, n_springs = 0, n_triangles = 0
    type(c_ptr) :: x = c_null_ptr, mass = c_null_ptr, ends = c_null_ptr, rest_length = c_null_ptr
    type(c_ptr) :: stiffness = c_null_ptr, triangles = c_null_ptr, viscosity = c_null_ptr, guard = c_null_ptr
    type(c_ptr) :: area_stiffness = c_null_ptr, thickness = c_null_ptr, modulus = c_null_ptr, flags = c_null_ptr
    type(c_ptr) :: body = c_null_ptr, position = c_null_ptr, velocity = c_null_ptr, coupling = c_null_ptr
    type(c_ptr) :: strength = c_null_ptr, critical_stretch = c_null_ptr, softening = c_null_ptr
    type(c_ptr) :: compressive_strength = c_null_ptr, confinement = c_null_ptr, own_stress = c_null_ptr
  end type

  type, bind(c) :: dem_weibull
    integer(c_size_t) :: struct_size = 56
    real(c_double) :: shape = 0, volume = 0, section = 0
    integer(c_int64_t) :: seed = 0
    integer(dem_index) :: body = 0
    type(c_ptr) :: number = c_null_ptr
  end type

  abstract interface

    logical(c_bool) function dem_lattice_cut_keep(context, x) bind(c)
      import
      type(c_ptr), value :: context
      real(c_double), intent(in) :: x(2, *)
    end function

  end interface

  interface

    subroutine dem_lattice_free(lattice) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
    end subroutine

    integer(dem_status) function dem_lattice_rectangle(out, width, height, spacing) bind(c)
      import
      type(dem_lattice), intent(inout) :: out
      real(c_double), value :: width, height, spacing
    end function

    integer(dem_status) function dem_lattice_squares(out, width, height, spacing) bind(c)
      import
      type(dem_lattice), intent(inout) :: out
      real(c_double), value :: width, height, spacing
    end function

    integer(dem_status) function dem_lattice_disc(out, radius, spacing) bind(c)
      import
      type(dem_lattice), intent(inout) :: out
      real(c_double), value :: radius, spacing
    end function

    integer(dem_status) function dem_lattice_cut(lattice, keep, context) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      procedure(dem_lattice_cut_keep) :: keep
      type(c_ptr), value :: context
    end function

    integer(dem_status) function dem_lattice_trim(lattice, keep) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      logical(c_bool), intent(in) :: keep(*)
    end function

    integer(dem_status) function dem_lattice_pieces(lattice, n_pieces, piece) bind(c)
      import
      type(dem_lattice), intent(in) :: lattice
      integer(dem_index), intent(out) :: n_pieces
      integer(dem_index), intent(out), optional :: piece(*)
    end function

    integer(dem_status) function dem_lattice_rims(lattice, n_edges) bind(c)
      import
      type(dem_lattice), intent(in) :: lattice
      integer(dem_index), intent(out) :: n_edges(*)
    end function

    integer(dem_status) function dem_lattice_assemble(lattice, material) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      type(dem_material), intent(in) :: material
    end function

    integer(dem_status) function dem_lattice_assemble_squares(lattice, material, diagonal) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      type(dem_material), intent(in) :: material
      real(c_double), value :: diagonal
    end function

    integer(dem_status) function dem_lattice_assemble_mixed(lattice, materials, n_materials, of, diagonal) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      type(dem_material), intent(in) :: materials(*)
      integer(dem_index), value :: n_materials
      integer(dem_index), intent(in), optional :: of(*)
      real(c_double), value :: diagonal
    end function

    integer(dem_status) function dem_lattice_weibull(lattice, laws, n_laws, of, triangle_factor, spring_factor) bind(c)
      import
      type(dem_lattice), intent(in) :: lattice
      type(dem_weibull), intent(in) :: laws(*)
      integer(dem_index), value :: n_laws
      integer(dem_index), intent(in), optional :: of(*)
      real(c_double), intent(out), optional :: triangle_factor(*), spring_factor(*)
    end function

    integer(dem_status) function dem_lattice_weaken(lattice, strength_factor, energy_factor, stretch_factor) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      real(c_double), intent(in), optional :: strength_factor(*), energy_factor(*), stretch_factor(*)
    end function

    integer(dem_status) function dem_lattice_jitter(lattice, radius, seed) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      real(c_double), value :: radius
      integer(c_int64_t), value :: seed
    end function

    integer(dem_status) function dem_lattice_parts(lattice, n_parts, part) bind(c)
      import
      type(dem_lattice), intent(in) :: lattice
      integer(dem_index), intent(out) :: n_parts
      integer(dem_index), intent(out), optional :: part(*)
    end function

    integer(dem_status) function dem_lattice_select(lattice, keep) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      logical(c_bool), intent(in) :: keep(*)
    end function

    subroutine dem_lattice_move(lattice, angle, offset) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      real(c_double), value :: angle
      real(c_double), intent(in) :: offset(2)
    end subroutine

    integer(dem_status) function dem_lattice_launch(lattice, velocity) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      real(c_double), intent(in) :: velocity(2)
    end function

    integer(dem_status) function dem_lattice_spin(lattice, angular_velocity) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      real(c_double), value :: angular_velocity
    end function

    integer(dem_status) function dem_lattice_spin_about(lattice, angular_velocity, centre) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      real(c_double), value :: angular_velocity
      real(c_double), intent(in) :: centre(2)
    end function

    integer(dem_status) function dem_lattice_exclude(lattice, nodes, n) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      integer(dem_index), intent(in) :: nodes(*)
      integer(dem_index), value :: n
    end function

    integer(dem_status) function dem_lattice_stiffen(lattice, guide) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      integer(dem_guide), value :: guide
    end function

    integer(dem_status) function dem_lattice_edge_shares(lattice, nodes, n, direction, area) bind(c)
      import
      type(dem_lattice), intent(in) :: lattice
      integer(dem_index), intent(in) :: nodes(*)
      integer(dem_index), value :: n
      real(c_double), intent(in), optional :: direction(2)
      real(c_double), intent(out) :: area(*)
    end function

    integer(dem_status) function dem_lattice_append(lattice, other) bind(c)
      import
      type(dem_lattice), intent(inout) :: lattice
      type(dem_lattice), intent(in) :: other
    end function

  end interface

  ! ---- dem/method.h --------------------------------------------------------------------------------------------------

  integer, parameter :: dem_method = c_int
  enum, bind(c)
    enumerator :: DEM_METHOD_FEHLBERG45 = 0, DEM_METHOD_DOPRI45 = 1, DEM_METHOD_CASHKARP45 = 2
    enumerator :: DEM_METHOD_ZONNEVELD34 = 3, DEM_METHOD_BS23 = 4, DEM_METHOD_HEUN12 = 5, DEM_METHOD_SAYFYABURUB34 = 6
    enumerator :: DEM_METHOD_ARK23 = 7, DEM_METHOD_ARK34 = 8, DEM_METHOD_ARK34B = 9, DEM_METHOD_ARK45 = 10
    enumerator :: DEM_METHOD_ARK45B = 11, DEM_METHOD_VERNER56 = 12, DEM_METHOD_VERNER67 = 13, DEM_METHOD_VERNER78 = 14
    enumerator :: DEM_METHOD_VERNER89 = 15, DEM_METHOD_FEHLBERG78 = 16, DEM_METHOD_KNOTHWOLKE3 = 17, DEM_METHOD_RK4 = 18
    enumerator :: DEM_METHOD_VERLET = 19
  end enum

  type, bind(c) :: dem_method_traits
    integer(c_size_t) :: struct_size = 48
    type(c_ptr) :: name = c_null_ptr
    integer(c_int32_t) :: order = 0, evaluations = 0
    logical(c_bool) :: adaptive = .false.
    real(c_double) :: stable = 0, usable = 0
  end type

  interface

    integer(dem_status) function dem_method_describe(out, method) bind(c)
      import
      type(dem_method_traits), intent(inout) :: out
      integer(dem_method), value :: method
    end function

    integer(dem_status) function dem_method_find(out, name) bind(c)
      import
      integer(dem_method), intent(out) :: out
      character(kind=c_char), intent(in) :: name(*)
    end function

    real(c_double) function dem_method_growth(method, omega_h) bind(c)
      import
      integer(dem_method), value :: method
      real(c_double), value :: omega_h
    end function

  end interface

  ! ---- dem/model.h ---------------------------------------------------------------------------------------------------

  integer, parameter :: dem_friction_law = c_int
  enum, bind(c)
    enumerator :: DEM_FRICTION_COULOMB = 0, DEM_FRICTION_PAPER = 1
  end enum

  type, bind(c) :: dem_pose
    integer(c_size_t) :: struct_size = 104
    real(c_double) :: place(3) = 0, velocity(3) = 0, acceleration(3) = 0, angle = 0, spin = 0, spin_rate = 0
  end type

  type, bind(c) :: dem_obstacle
    integer(c_size_t) :: struct_size = 192
    integer(dem_index) :: n_points = 0
    type(c_ptr) :: points = c_null_ptr
    real(c_double) :: restitution = 0, friction = 0
    integer(dem_friction_law) :: friction_law = 0
    real(c_double) :: velocity(3) = 0, amplitude(3) = 0, frequency = 0, phase = 0, pivot(3) = 0, spin = 0, ramp = 0
    type(c_funptr) :: motion = c_null_funptr
    type(c_ptr) :: motion_context = c_null_ptr
    real(c_double) :: most_speed = 0, most_acceleration = 0, longest_step = 0
  end type

  type, bind(c) :: dem_motion_field
    type(c_ptr) :: name = c_null_ptr, unit = c_null_ptr
    integer(dem_index) :: n = 0
    integer(c_size_t) :: offset = 0
  end type

  type, bind(c) :: dem_csr
    integer(c_size_t) :: struct_size = 64
    integer(dem_index) :: n_nodes = 0
    type(c_ptr) :: row = c_null_ptr, neighbour = c_null_ptr, spring = c_null_ptr, stiffness = c_null_ptr
    type(c_ptr) :: rest_length = c_null_ptr, viscosity = c_null_ptr
  end type

  type, bind(c) :: dem_model_size
    integer(c_size_t) :: struct_size = 80
    integer(dem_index) :: n_nodes = 0, n_springs = 0, n_triangles = 0, n_bodies = 0, n_contact_nodes = 0
    integer(dem_index) :: n_contact_edges = 0, n_obstacles = 0, n_segments = 0, n_vertices = 0
  end type

  type, bind(c) :: dem_constants
    integer(c_size_t) :: struct_size = 128
    real(c_double) :: stiffness(3, 3) = 0, youngs_modulus = 0, poissons_ratio = 0, anisotropy = 0
    real(c_double) :: longitudinal_speed = 0, transverse_speed = 0, volume = 0
  end type

  abstract interface

    integer(dem_status) function dem_motion(context, t, pose) bind(c)
      import
      type(c_ptr), value :: context
      real(c_double), value :: t
      type(dem_pose), intent(inout) :: pose
    end function

  end interface

  interface

    type(c_ptr) function dem_motion_field_at(k) bind(c)
      import
      integer(dem_index), value :: k
    end function

    logical(c_bool) function dem_obstacle_moves(obstacle, by) bind(c)
      import
      type(dem_obstacle), intent(in) :: obstacle
      type(dem_motion_field), intent(in), optional :: by
    end function

    integer(dem_status) function dem_obstacle_points(obstacle, t, points) bind(c)
      import
      type(dem_obstacle), intent(in) :: obstacle
      real(c_double), value :: t
      real(c_double), intent(out) :: points(2, *)
    end function

    integer(dem_status) function dem_obstacle_velocity(obstacle, t, x, velocity) bind(c)
      import
      type(dem_obstacle), intent(in) :: obstacle
      real(c_double), value :: t
      real(c_double), intent(in) :: x(*)
      real(c_double), intent(out) :: velocity(*)
    end function

    integer(dem_status) function dem_obstacle_check(obstacle, segments) bind(c)
      import
      type(dem_obstacle), intent(in) :: obstacle
      integer(dem_index), intent(out) :: segments(2)
    end function

    integer(dem_status) function dem_model_create(out, lattice, obstacles, n_obstacles) bind(c)
      import
      type(c_ptr), intent(out) :: out
      type(dem_lattice), intent(in) :: lattice
      type(dem_obstacle), intent(in), optional :: obstacles(*)
      integer(dem_index), value :: n_obstacles
    end function

    integer(dem_status) function dem_model_create_borrowing(out, lattice, obstacles, n_obstacles) bind(c)
      import
      type(c_ptr), intent(out) :: out
      type(dem_lattice), intent(in) :: lattice
      type(dem_obstacle), intent(in), optional :: obstacles(*)
      integer(dem_index), value :: n_obstacles
    end function

    subroutine dem_model_destroy(model) bind(c)
      import
      type(c_ptr), value :: model
    end subroutine

    integer(dem_status) function dem_model_csr(model, out) bind(c)
      import
      type(c_ptr), value :: model
      type(dem_csr), intent(inout) :: out
    end function

    type(c_ptr) function dem_model_lattice(model) bind(c)
      import
      type(c_ptr), value :: model
    end function

    type(c_ptr) function dem_model_obstacle(model, obstacle) bind(c)
      import
      type(c_ptr), value :: model
      integer(dem_index), value :: obstacle
    end function

    integer(dem_status) function dem_model_part(model, n_nodes, number, is_own) bind(c)
      import
      type(c_ptr), value :: model
      integer(dem_index), intent(out) :: n_nodes
      type(c_ptr), intent(out) :: number, is_own
    end function

    integer(dem_status) function dem_model_sizes(model, out) bind(c)
      import
      type(c_ptr), value :: model
      type(dem_model_size), intent(inout) :: out
    end function

    real(c_double) function dem_model_spacing(model) bind(c)
      import
      type(c_ptr), value :: model
    end function

    real(c_double) function dem_model_omega_max(model) bind(c)
      import
      type(c_ptr), value :: model
    end function

    integer(dem_status) function dem_model_omega(model, omega) bind(c)
      import
      type(c_ptr), value :: model
      real(c_double), intent(out) :: omega
    end function

    integer(dem_status) function dem_model_constants(model, body, out) bind(c)
      import
      type(c_ptr), value :: model
      integer(dem_index), value :: body
      type(dem_constants), intent(inout) :: out
    end function

    real(c_double) function dem_model_mass(model) bind(c)
      import
      type(c_ptr), value :: model
    end function

    type(c_ptr) function dem_model_volumes(model) bind(c)
      import
      type(c_ptr), value :: model
    end function

    real(c_double) function dem_model_gap(model, x) bind(c)
      import
      type(c_ptr), value :: model
      real(c_double), intent(in) :: x(*)
    end function

  end interface

  ! ---- dem/simulation.h ----------------------------------------------------------------------------------------------

  integer, parameter :: dem_boundary_kind = c_int
  enum, bind(c)
    enumerator :: DEM_BOUNDARY_VELOCITY = 0, DEM_BOUNDARY_DISPLACEMENT = 1, DEM_BOUNDARY_FORCE = 2
  end enum

  enum, bind(c)
    enumerator :: DEM_COMPONENT_X = 1, DEM_COMPONENT_Y = 2
  end enum

  integer, parameter :: dem_kernel = c_int
  enum, bind(c)
    enumerator :: DEM_KERNEL_AUTO = 0, DEM_KERNEL_PORTABLE = 1, DEM_KERNEL_AVX2 = 2, DEM_KERNEL_AVX512 = 3
  end enum

  integer, parameter :: dem_contact_method = c_int
  enum, bind(c)
    enumerator :: DEM_CONTACT_LOCAL = 0, DEM_CONTACT_EXACT = 1
  end enum

  integer, parameter :: dem_bodies = c_int
  enum, bind(c)
    enumerator :: DEM_BODIES_NONE = 0, DEM_BODIES_OTHERS = 1, DEM_BODIES_ALL = 2
  end enum

  integer, parameter :: dem_contact_state = c_int
  enum, bind(c)
    enumerator :: DEM_CONTACT_FREE = 0, DEM_CONTACT_SLIP = 1, DEM_CONTACT_STICK = 2
  end enum

  integer, parameter :: dem_event_kind = c_int
  enum, bind(c)
    enumerator :: DEM_EVENT_IMPACT = 0, DEM_EVENT_CLOSE = 1, DEM_EVENT_RELEASE = 2, DEM_EVENT_SLIP = 3
    enumerator :: DEM_EVENT_STICK = 4, DEM_EVENT_PASS = 5
  end enum

  type, bind(c) :: dem_boundary
    integer(c_size_t) :: struct_size = 72
    integer(dem_boundary_kind) :: kind = 0
    integer(c_int32_t) :: components = 0
    integer(dem_index) :: n_nodes = 0
    type(c_ptr) :: nodes = c_null_ptr, share = c_null_ptr
    real(c_double) :: value(3) = 0, ramp = 0
  end type

  type, bind(c) :: dem_force_query
    real(c_double) :: t = 0
    integer(dem_index) :: n = 0
    type(c_ptr) :: nodes = c_null_ptr, x = c_null_ptr, v = c_null_ptr
  end type

  type, bind(c) :: dem_options
    integer(c_size_t) :: struct_size = 240
    integer(dem_method) :: method = 0
    real(c_double) :: gravity(3) = 0, rtol = 0, spacing = 0, v_scale = 0, max_step = 0, fixed_step = 0
    real(c_double) :: penetration_tolerance = 0, rest_speed = 0
    integer(dem_index) :: max_impacts = 0
    real(c_double) :: window = 0, mass_damping = 0
    logical(c_bool) :: vertices = .false.
    integer(dem_contact_method) :: contact = 0
    integer(dem_kernel) :: kernel = 0
    integer(c_int32_t) :: threads = 0
    integer(dem_index) :: checkpoint_steps = 0, n_boundaries = 0
    type(c_ptr) :: boundaries = c_null_ptr
    type(c_funptr) :: force = c_null_funptr
    type(c_ptr) :: force_context = c_null_ptr
    integer(dem_bodies) :: bodies = 0
    real(c_double) :: contact_thickness = 0, contact_stiffness = 0, contact_friction = 0
    integer(dem_index) :: n_body_frictions = 0
    type(c_ptr) :: body_friction = c_null_ptr
    real(c_double) :: pause = 0
    integer(dem_index) :: thread_nodes = 0
  end type

  type, bind(c) :: dem_energy
    integer(c_size_t) :: struct_size = 128
    real(c_double) :: ledger = 0, motion = 0, kinetic = 0, elastic = 0, area = 0, guard = 0, contact = 0, gravity = 0
    real(c_double) :: impact = 0, friction = 0, damping = 0, fracture = 0, projection = 0, boundary = 0, obstacle = 0
  end type

  type, bind(c) :: dem_contact
    integer(c_size_t) :: struct_size = 184
    integer(dem_contact_state) :: state = 0
    integer(c_int32_t) :: n_nodes = 0
    integer(dem_index) :: nodes(4) = 0
    real(c_double) :: weights(4) = 0
    integer(dem_index) :: body = 0, obstacle = 0, segment = 0, other_body = 0
    real(c_double) :: x(3) = 0, normal(3) = 0, force = 0, friction(2) = 0
  end type

  type, bind(c) :: dem_event
    integer(c_size_t) :: struct_size = 208
    real(c_double) :: t = 0
    integer(dem_event_kind) :: kind = 0
    integer(dem_contact_state) :: state = 0
    integer(dem_index) :: node = 0, other = 0
    real(c_double) :: weight = 0
    integer(dem_index) :: body = 0, obstacle = 0, segment = 0, other_body = 0
    real(c_double) :: x(3) = 0, normal(3) = 0, impulse(3) = 0, before(3) = 0, after(3) = 0, energy = 0
  end type

  type, bind(c) :: dem_state
    integer(c_size_t) :: struct_size = 48
    real(c_double) :: t = 0, step = 0
    type(c_ptr) :: x = c_null_ptr, v = c_null_ptr
    integer(dem_index) :: n_contacts = 0
  end type

  type, bind(c) :: dem_progress
    integer(c_size_t) :: struct_size = 32
    real(c_double) :: t = 0, step = 0
    integer(dem_index) :: n_contacts = 0
  end type

  type, bind(c) :: dem_body_motion
    integer(c_size_t) :: struct_size = 88
    real(c_double) :: mass = 0, centre(3) = 0, velocity(3) = 0, angular_momentum(3) = 0
  end type

  type, bind(c) :: dem_obstacle_load
    integer(c_size_t) :: struct_size = 152
    real(c_double) :: reaction(3) = 0, point(3) = 0, impulse(3) = 0, friction_impulse(3) = 0
    integer(dem_index) :: n_contacts = 0
    real(c_double) :: displacement(3) = 0, angle = 0, power = 0
  end type

  type, bind(c) :: dem_boundary_load
    integer(c_size_t) :: struct_size = 56
    real(c_double) :: force(3) = 0, displacement(3) = 0
  end type

  type, bind(c) :: dem_counts
    integer(c_size_t) :: struct_size = 136
    integer(dem_index) :: steps = 0, rejected = 0, evaluations = 0, events = 0, impacts = 0, vertex_impacts = 0
    integer(dem_index) :: early = 0, closings = 0, releases = 0, slips = 0, sticks = 0, passings = 0, late = 0
    integer(dem_index) :: retries = 0, behind = 0, crossings = 0
  end type

  type, bind(c) :: dem_strain
    integer(c_size_t) :: struct_size = 64
    real(c_double) :: min = 0, max = 0
    integer(dem_index) :: spring_min = 0, spring_max = 0
    real(c_double) :: area_min = 0
    integer(dem_index) :: guarded = 0, inverted = 0
  end type

  type, bind(c) :: dem_overlap
    integer(c_size_t) :: struct_size = 72
    integer(dem_index) :: now = 0, most = 0
    real(c_double) :: t = 0
    integer(dem_index) :: node = 0, triangle = 0
    real(c_double) :: x(3) = 0
  end type

  type, bind(c) :: dem_surfaces
    integer(c_size_t) :: struct_size = 104
    real(c_double) :: gap_min = 0, gap_share = 0, thickness_min = 0, thickness_max = 0
    integer(dem_index) :: pushing = 0, n_edges = 0, left_out = 0
    real(c_double) :: modulus_min = 0, modulus_max = 0, pressure_share = 0, friction_min = 0, friction_max = 0
  end type

  type, bind(c) :: dem_pair
    integer(c_size_t) :: struct_size = 168
    integer(dem_index) :: node = 0, edge(2) = 0, body = 0, other_body = 0
    real(c_double) :: x(3) = 0, normal(3) = 0, gap = 0, thickness = 0, force(3) = 0, friction(3) = 0
    integer(c_int32_t) :: slides = 0
  end type

  type, bind(c) :: dem_fracture
    integer(c_size_t) :: struct_size = 112
    integer(dem_index) :: triangles = 0, springs = 0, fragments = 0
    real(c_double) :: largest = 0, debris = 0, median = 0, crack_length = 0
    integer(dem_index) :: buried = 0, buried_node = 0
    real(c_double) :: buried_t = 0, buried_x(3) = 0
  end type

  abstract interface

    integer(dem_status) function dem_force(context, query, force) bind(c)
      import
      type(c_ptr), value :: context
      type(dem_force_query), intent(in) :: query
      real(c_double), intent(inout) :: force(2, *)
    end function

  end interface

  interface

    integer(dem_status) function dem_kernel_find(out, name) bind(c)
      import
      integer(dem_kernel), intent(out) :: out
      character(kind=c_char), intent(in) :: name(*)
    end function

    type(c_ptr) function c_kernel_name(kind) bind(c, name='dem_kernel_name')
      import
      integer(dem_kernel), value :: kind
    end function

    integer(dem_status) function dem_kernel_check(kind) bind(c)
      import
      integer(dem_kernel), value :: kind
    end function

    integer(dem_status) function dem_simulation_create(out, model, options) bind(c)
      import
      type(c_ptr), intent(out) :: out
      type(c_ptr), value :: model
      type(dem_options), intent(in) :: options
    end function

    integer(dem_status) function dem_simulation_resume(out, model, options, checkpoint) bind(c)
      import
      type(c_ptr), intent(out) :: out
      type(c_ptr), value :: model
      type(dem_options), intent(in) :: options
      type(c_ptr), value :: checkpoint
    end function

    subroutine dem_simulation_destroy(simulation) bind(c)
      import
      type(c_ptr), value :: simulation
    end subroutine

    integer(dem_status) function dem_simulation_advance(simulation, t_end) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), value :: t_end
    end function

    integer(dem_status) function dem_simulation_set_motion(simulation, x, v) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), intent(in), optional :: x(2, *), v(2, *)
    end function

    integer(dem_status) function dem_simulation_break(simulation, triangle, n_triangles, spring, n_springs) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(dem_index), intent(in), optional :: triangle(*)
      integer(dem_index), value :: n_triangles
      integer(dem_index), intent(in), optional :: spring(*)
      integer(dem_index), value :: n_springs
    end function

    type(c_ptr) function dem_simulation_checkpoint(simulation) bind(c)
      import
      type(c_ptr), value :: simulation
    end function

    integer(dem_status) function dem_simulation_state(simulation, out) bind(c)
      import
      type(c_ptr), value :: simulation
      type(dem_state), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_progress(simulation, out) bind(c)
      import
      type(c_ptr), value :: simulation
      type(dem_progress), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_gather(simulation, x, v) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), intent(out) :: x(2, *), v(2, *)
    end function

    integer(dem_status) function dem_simulation_energy(simulation, out) bind(c)
      import
      type(c_ptr), value :: simulation
      type(dem_energy), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_strain(simulation, out) bind(c)
      import
      type(c_ptr), value :: simulation
      type(dem_strain), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_contact(simulation, contact, out) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(dem_index), value :: contact
      type(dem_contact), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_strains(simulation, strain) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), intent(out) :: strain(*)
    end function

    integer(dem_status) function dem_simulation_forces(simulation, force) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), intent(out) :: force(*)
    end function

    integer(dem_status) function dem_simulation_force_at(simulation, spring, out) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(dem_index), value :: spring
      real(c_double), intent(out) :: out
    end function

    integer(dem_status) function dem_simulation_broken(simulation, triangle, spring) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(c_signed_char), intent(out), optional :: triangle(*), spring(*)
    end function

    integer(dem_status) function dem_simulation_damage(simulation, triangle, node) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), intent(out), optional :: triangle(*), node(*)
    end function

    integer(dem_status) function dem_simulation_fragments(simulation, n_fragments, fragment) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(dem_index), intent(out) :: n_fragments, fragment(*)
    end function

    integer(dem_status) function dem_simulation_fracture(simulation, out) bind(c)
      import
      type(c_ptr), value :: simulation
      type(dem_fracture), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_crack_energy(simulation, energy) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), intent(out) :: energy
    end function

    integer(dem_status) function dem_simulation_stress(simulation, stress) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), intent(out) :: stress(3, *)
    end function

    integer(dem_status) function dem_simulation_stress_at(simulation, node, stress) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(dem_index), value :: node
      real(c_double), intent(out) :: stress(3, *)
    end function

    integer(dem_status) function dem_simulation_overlap(simulation, out) bind(c)
      import
      type(c_ptr), value :: simulation
      type(dem_overlap), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_surfaces(simulation, out) bind(c)
      import
      type(c_ptr), value :: simulation
      type(dem_surfaces), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_pair(simulation, pair, out) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(dem_index), value :: pair
      type(dem_pair), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_contact_forces(simulation, force) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), intent(out) :: force(2, *)
    end function

    integer(dem_status) function dem_simulation_contact_pressures(simulation, pressure) bind(c)
      import
      type(c_ptr), value :: simulation
      real(c_double), intent(out) :: pressure(*)
    end function

    integer(dem_status) function dem_simulation_counts(simulation, out) bind(c)
      import
      type(c_ptr), value :: simulation
      type(dem_counts), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_body(simulation, body, out) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(dem_index), value :: body
      type(dem_body_motion), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_inertia(simulation, body, inertia) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(dem_index), value :: body
      real(c_double), intent(out) :: inertia
    end function

    integer(dem_status) function dem_simulation_obstacle(simulation, obstacle, out) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(dem_index), value :: obstacle
      type(dem_obstacle_load), intent(inout) :: out
    end function

    integer(dem_status) function dem_simulation_boundary(simulation, boundary, out) bind(c)
      import
      type(c_ptr), value :: simulation
      integer(dem_index), value :: boundary
      type(dem_boundary_load), intent(inout) :: out
    end function

    real(c_double) function dem_simulation_fastest(simulation) bind(c)
      import
      type(c_ptr), value :: simulation
    end function

    real(c_double) function dem_simulation_residual(simulation) bind(c)
      import
      type(c_ptr), value :: simulation
    end function

    real(c_double) function dem_simulation_ramp_time(simulation) bind(c)
      import
      type(c_ptr), value :: simulation
    end function

    type(c_ptr) function dem_simulation_model(simulation) bind(c)
      import
      type(c_ptr), value :: simulation
    end function

    integer(dem_status) function dem_simulation_options(simulation, out) bind(c)
      import
      type(c_ptr), value :: simulation
      type(dem_options), intent(inout) :: out
    end function

    real(c_double) function dem_stress_von_mises(stress) bind(c)
      import
      real(c_double), intent(in) :: stress(3)
    end function

    subroutine dem_stress_principal(stress, value, direction) bind(c)
      import
      real(c_double), intent(in) :: stress(3)
      real(c_double), intent(out) :: value(2), direction(2)
    end subroutine

  end interface

  ! ---- dem/observer.h ------------------------------------------------------------------------------------------------

  type, bind(c) :: dem_break
    integer(c_size_t) :: struct_size = 104
    real(c_double) :: t = 0
    integer(dem_index) :: triangle = 0, spring = 0, body = 0
    real(c_double) :: x(3) = 0, stress(3) = 0, energy = 0
    integer(dem_index) :: fragment_new = 0
  end type

  type, bind(c) :: dem_observer
    integer(c_size_t) :: struct_size = 88
    real(c_double) :: interval = 0
    type(c_funptr) :: frame = c_null_funptr, step = c_null_funptr, event = c_null_funptr, checkpoint = c_null_funptr
    type(c_ptr) :: context = c_null_ptr
    type(c_funptr) :: broken = c_null_funptr
    integer(dem_index) :: step_every = 0
    real(c_double) :: step_interval = 0
    integer(dem_index) :: step_touching = 0
  end type

  type, bind(c) :: dem_node_peak
    real(c_double) :: von_mises = 0, t = 0, stress(3) = 0
  end type

  type, bind(c) :: dem_spring_peak
    real(c_double) :: strain = 0, t = 0
  end type

  abstract interface

    integer(dem_status) function dem_observer_frame(context, simulation) bind(c)
      import
      type(c_ptr), value :: context, simulation
    end function

    integer(dem_status) function dem_observer_step(context, simulation) bind(c)
      import
      type(c_ptr), value :: context, simulation
    end function

    integer(dem_status) function dem_observer_event(context, simulation, event) bind(c)
      import
      type(c_ptr), value :: context, simulation
      type(dem_event), intent(in) :: event
    end function

    integer(dem_status) function dem_observer_checkpoint(context, simulation, checkpoint) bind(c)
      import
      type(c_ptr), value :: context, simulation, checkpoint
    end function

    integer(dem_status) function dem_observer_broken(context, simulation, what) bind(c)
      import
      type(c_ptr), value :: context, simulation
      type(dem_break), intent(in) :: what
    end function

  end interface

  interface

    integer(dem_status) function dem_simulation_observe(simulation, observer) bind(c)
      import
      type(c_ptr), value :: simulation
      type(dem_observer), intent(in) :: observer
    end function

    integer(dem_status) function dem_peaks_create(out, model, every) bind(c)
      import
      type(c_ptr), intent(out) :: out
      type(c_ptr), value :: model
      integer(dem_index), value :: every
    end function

    integer(dem_status) function dem_peaks_resume(out, model, every, checkpoint) bind(c)
      import
      type(c_ptr), intent(out) :: out
      type(c_ptr), value :: model
      integer(dem_index), value :: every
      type(c_ptr), value :: checkpoint
    end function

    subroutine dem_peaks_destroy(peaks) bind(c)
      import
      type(c_ptr), value :: peaks
    end subroutine

    integer(dem_status) function dem_peaks_observer(peaks, out) bind(c)
      import
      type(c_ptr), value :: peaks
      type(dem_observer), intent(inout) :: out
    end function

    type(c_ptr) function dem_peaks_nodes(peaks) bind(c)
      import
      type(c_ptr), value :: peaks
    end function

    type(c_ptr) function dem_peaks_springs(peaks) bind(c)
      import
      type(c_ptr), value :: peaks
    end function

    integer(dem_index) function dem_peaks_most_stressed_nodes(peaks, n, nodes) bind(c)
      import
      type(c_ptr), value :: peaks
      integer(dem_index), value :: n
      integer(dem_index), intent(out) :: nodes(*)
    end function

    integer(dem_index) function dem_peaks_most_strained_springs(peaks, n, springs) bind(c)
      import
      type(c_ptr), value :: peaks
      integer(dem_index), value :: n
      integer(dem_index), intent(out) :: springs(*)
    end function

  end interface

  ! ---- dem/shape.h ---------------------------------------------------------------------------------------------------

  integer, parameter :: dem_outline_kind = c_int
  enum, bind(c)
    enumerator :: DEM_OUTLINE_RECTANGLE = 0, DEM_OUTLINE_DISC = 1, DEM_OUTLINE_RING = 2, DEM_OUTLINE_POLYGON = 3
  end enum

  enum, bind(c)
    enumerator :: DEM_OUTLINE_MAX_POINTS = 10000
  end enum

  enum, bind(c)
    enumerator :: DEM_IMAGE_MAX_SIDE = 32768
  end enum

  integer, parameter :: dem_grid = c_int
  enum, bind(c)
    enumerator :: DEM_GRID_TRIANGLES = 0, DEM_GRID_SQUARES = 1
  end enum

  integer, parameter :: dem_edge = c_int
  enum, bind(c)
    enumerator :: DEM_EDGE_STEPPED = 0, DEM_EDGE_SMOOTH = 1
  end enum

  enum, bind(c)
    enumerator :: DEM_PORES_MAX = 10000
  end enum

  integer, parameter :: dem_pore_radii = c_int
  enum, bind(c)
    enumerator :: DEM_PORE_RADII_UNIFORM = 0, DEM_PORE_RADII_LOGNORMAL = 1, DEM_PORE_RADII_NORMAL = 2
  end enum

  type, bind(c) :: dem_outline
    integer(c_size_t) :: struct_size = 88
    integer(dem_outline_kind) :: kind = 0
    real(c_double) :: centre(2) = 0, angle = 0, size(2) = 0, radius = 0, inner_radius = 0
    integer(dem_index) :: n_points = 0
    type(c_ptr) :: points = c_null_ptr
  end type

  type, bind(c) :: dem_image
    integer(c_size_t) :: struct_size = 40
    integer(dem_index) :: width = 0, height = 0
    real(c_double) :: pixel = 0
    type(c_ptr) :: solid = c_null_ptr
  end type

  type, bind(c) :: dem_shape
    integer(c_size_t) :: struct_size = 88
    type(c_ptr) :: outline = c_null_ptr, image = c_null_ptr
    real(c_double) :: spacing = 0
    integer(dem_grid) :: grid = 0
    integer(dem_edge) :: edge = 0
    integer(dem_index) :: n_voids = 0
    type(c_ptr) :: voids = c_null_ptr
    integer(dem_index) :: n_pores = 0
    type(c_ptr) :: pores = c_null_ptr
    logical(c_bool) :: numbered = .false.
    type(c_ptr) :: name = c_null_ptr
  end type

  type, bind(c) :: dem_shape_report
    integer(c_size_t) :: struct_size = 48
    integer(dem_index) :: n_rim = 0, n_off = 0, n_cut = 0
    real(c_double) :: farthest = 0
    integer(dem_index) :: idle_void = 0
  end type

  type, bind(c) :: dem_pores
    integer(c_size_t) :: struct_size = 80
    integer(dem_index) :: number = 0
    real(c_double) :: area = 0, radius_min = 0, radius_max = 0
    integer(dem_pore_radii) :: distribution = 0
    real(c_double) :: mean = 0, deviation = 0, wall = 0
    integer(c_int64_t) :: seed = 0
  end type

  type, bind(c) :: dem_mesh
    integer(c_size_t) :: struct_size = 48
    type(c_ptr) :: path = c_null_ptr, text = c_null_ptr
    integer(dem_index) :: size = 0
    real(c_double) :: scale = 0
    logical(c_bool) :: numbered = .false.
  end type

  interface

    integer(dem_status) function dem_points_check(points, n) bind(c)
      import
      real(c_double), intent(in) :: points(2, *)
      integer(dem_index), value :: n
    end function

    integer(dem_status) function dem_outline_check(outline) bind(c)
      import
      type(dem_outline), intent(in) :: outline
    end function

    integer(dem_status) function dem_outline_box(outline, box) bind(c)
      import
      type(dem_outline), intent(in) :: outline
      real(c_double), intent(out) :: box(4)
    end function

    integer(dem_status) function dem_outline_distance(outline, x, n, distance) bind(c)
      import
      type(dem_outline), intent(in) :: outline
      real(c_double), intent(in) :: x(2, *)
      integer(dem_index), value :: n
      real(c_double), intent(out) :: distance(*)
    end function

    integer(dem_index) function dem_outline_corners(outline) bind(c)
      import
      type(dem_outline), intent(in) :: outline
    end function

    integer(dem_status) function dem_outline_corner(outline, k, x) bind(c)
      import
      type(dem_outline), intent(in) :: outline
      integer(dem_index), value :: k
      real(c_double), intent(out) :: x(2)
    end function

    integer(dem_status) function dem_shape_lattice(out, shape, report) bind(c)
      import
      type(dem_lattice), intent(inout) :: out
      type(dem_shape), intent(in) :: shape
      type(dem_shape_report), intent(inout), optional :: report
    end function

    integer(dem_status) function dem_shape_area(shape, area) bind(c)
      import
      type(dem_shape), intent(in) :: shape
      real(c_double), intent(out) :: area
    end function

    integer(dem_status) function dem_shape_place_pores(shape, recipe, pores, capacity, n) bind(c)
      import
      type(dem_shape), intent(in) :: shape
      type(dem_pores), intent(in) :: recipe
      real(c_double), intent(out) :: pores(3, *)
      integer(dem_index), value :: capacity
      integer(dem_index), intent(out) :: n
    end function

    integer(dem_status) function dem_mesh_lattice(out, mesh) bind(c)
      import
      type(dem_lattice), intent(inout) :: out
      type(dem_mesh), intent(in) :: mesh
    end function

    integer(dem_status) function dem_lattice_inside(lattice, outline, step, triangles, springs) bind(c)
      import
      type(dem_lattice), intent(in) :: lattice
      type(dem_outline), intent(in) :: outline
      integer(dem_index), value :: step
      logical(c_bool), intent(out), optional :: triangles(*), springs(*)
    end function

    integer(dem_status) function dem_lattice_crossed(lattice, points, n_points, aside, triangles, springs) bind(c)
      import
      type(dem_lattice), intent(in) :: lattice
      real(c_double), intent(in) :: points(2, *)
      integer(dem_index), value :: n_points
      real(c_double), value :: aside
      logical(c_bool), intent(out), optional :: triangles(*), springs(*)
    end function

    integer(dem_status) function dem_lattice_least_angle(lattice, angle) bind(c)
      import
      type(dem_lattice), intent(in) :: lattice
      real(c_double), intent(out) :: angle
    end function

  end interface

  ! ---- dem/slab.h ----------------------------------------------------------------------------------------------------

  type, bind(c) :: dem_slab
    integer(c_size_t) :: struct_size = 288
    integer(dem_index) :: n_nodes = 0, n_triangles = 0, first_node = 0, first_triangle = 0, first_own = 0, n_own = 0
    type(c_ptr) :: rim = c_null_ptr, rim_boundary = c_null_ptr
    type(dem_lattice) :: lattice
  end type

  interface

    subroutine dem_slab_free(slab) bind(c)
      import
      type(dem_slab), intent(inout) :: slab
    end subroutine

    integer(dem_status) function dem_slab_rectangle(out, width, height, spacing, part, n_parts) bind(c)
      import
      type(dem_slab), intent(inout) :: out
      real(c_double), value :: width, height, spacing
      integer(dem_index), value :: part, n_parts
    end function

    integer(dem_status) function dem_slab_squares(out, width, height, spacing, part, n_parts) bind(c)
      import
      type(dem_slab), intent(inout) :: out
      real(c_double), value :: width, height, spacing
      integer(dem_index), value :: part, n_parts
    end function

    integer(dem_status) function dem_slab_shape(out, shape, part, n_parts) bind(c)
      import
      type(dem_slab), intent(inout) :: out
      type(dem_shape), intent(in) :: shape
      integer(dem_index), value :: part, n_parts
    end function

    integer(dem_status) function dem_slab_jitter(slab, radius, seed) bind(c)
      import
      type(dem_slab), intent(inout) :: slab
      real(c_double), value :: radius
      integer(c_int64_t), value :: seed
    end function

  end interface

  ! ---- dem/dem.h -----------------------------------------------------------------------------------------------------

  ! ---- dem/reader.h --------------------------------------------------------------------------------------------------

  integer, parameter :: dem_reader_type = c_int
  enum, bind(c)
    enumerator :: DEM_READER_F64 = 0, DEM_READER_F32 = 1, DEM_READER_I64 = 2, DEM_READER_I32 = 3, DEM_READER_I8 = 4
    enumerator :: DEM_READER_U8 = 5
  end enum

  type, bind(c) :: dem_reader_array
    type(c_ptr) :: name = c_null_ptr, unit = c_null_ptr
    integer(dem_reader_type) :: type = 0
    logical(c_bool) :: of_springs = .false.
    integer(c_int) :: components = 0
    logical(c_bool) :: constant = .false.
  end type

  type, bind(c) :: dem_reader_column
    type(c_ptr) :: table = c_null_ptr, name = c_null_ptr, unit = c_null_ptr
    integer(dem_reader_type) :: type = 0
    integer(dem_index) :: n_rows = 0, items = 0, components = 0, width = 0
  end type

  interface

    integer(dem_status) function dem_reader_open(out, path) bind(c)
      import
      type(c_ptr), intent(out) :: out
      character(kind=c_char), intent(in) :: path(*)
    end function

    subroutine dem_reader_close(reader) bind(c)
      import
      type(c_ptr), value :: reader
    end subroutine

    type(c_ptr) function dem_reader_lattice(reader) bind(c)
      import
      type(c_ptr), value :: reader
    end function

    integer(dem_index) function dem_reader_n_obstacles(reader) bind(c)
      import
      type(c_ptr), value :: reader
    end function

    type(c_ptr) function dem_reader_obstacle(reader, obstacle) bind(c)
      import
      type(c_ptr), value :: reader
      integer(dem_index), value :: obstacle
    end function

    type(c_ptr) function dem_reader_times(reader, n_frames) bind(c)
      import
      type(c_ptr), value :: reader
      integer(dem_index), intent(out) :: n_frames
    end function

    type(c_ptr) function dem_reader_arrays(reader, n) bind(c)
      import
      type(c_ptr), value :: reader
      integer(dem_index), intent(out) :: n
    end function

    type(c_ptr) function dem_reader_array_find(reader, name) bind(c)
      import
      type(c_ptr), value :: reader
      character(kind=c_char), intent(in) :: name(*)
    end function

    integer(dem_status) function dem_reader_positions(reader, frame, x) bind(c)
      import
      type(c_ptr), value :: reader
      integer(dem_index), value :: frame
      real(c_double), intent(out) :: x(2, *)
    end function

    integer(dem_status) function dem_reader_read(reader, array, frame, values) bind(c)
      import
      type(c_ptr), value :: reader
      type(dem_reader_array), intent(in) :: array
      integer(dem_index), value :: frame
      real(c_double), intent(out) :: values(*)
    end function

    integer(dem_status) function dem_reader_broken_triangles(reader, frame, triangle) bind(c)
      import
      type(c_ptr), value :: reader
      integer(dem_index), value :: frame
      integer(c_signed_char), intent(out) :: triangle(*)
    end function

    type(c_ptr) function dem_reader_columns(reader, n) bind(c)
      import
      type(c_ptr), value :: reader
      integer(dem_index), intent(out) :: n
    end function

    type(c_ptr) function dem_reader_column_find(reader, table, name) bind(c)
      import
      type(c_ptr), value :: reader
      character(kind=c_char), intent(in) :: table(*), name(*)
    end function

    integer(dem_status) function dem_reader_fragments(reader, frame, first, count) bind(c)
      import
      type(c_ptr), value :: reader
      integer(dem_index), value :: frame
      integer(dem_index), intent(out) :: first, count
    end function

    integer(dem_status) function dem_reader_read_column(reader, column, values) bind(c)
      import
      type(c_ptr), value :: reader
      type(dem_reader_column), intent(in) :: column
      real(c_double), intent(out) :: values(*)
    end function

    integer(dem_status) function dem_reader_read_rows(reader, column, first, count, values) bind(c)
      import
      type(c_ptr), value :: reader
      type(dem_reader_column), intent(in) :: column
      integer(dem_index), value :: first, count
      real(c_double), intent(out) :: values(*)
    end function

  end interface

  ! ---- dem/trajectory.h ----------------------------------------------------------------------------------------------

  enum, bind(c)
    enumerator :: DEM_FIELD_DISPLACEMENT = 1, DEM_FIELD_VELOCITY = 2, DEM_FIELD_STRESS = 4, DEM_FIELD_VON_MISES = 8
    enumerator :: DEM_FIELD_PRINCIPAL = 16, DEM_FIELD_STRAIN = 32, DEM_FIELD_FORCE = 64, DEM_FIELD_CONTACT = 128
    enumerator :: DEM_FIELD_FRAGMENT = 256, DEM_FIELD_DAMAGE = 512, DEM_FIELD_ALL = 1023
  end enum

  integer, parameter :: dem_probe_kind = c_int
  enum, bind(c)
    enumerator :: DEM_PROBE_NODE = 0, DEM_PROBE_SPRING = 1, DEM_PROBE_GAUGE = 2
  end enum

  type, bind(c) :: dem_probe
    type(c_ptr) :: name = c_null_ptr
    integer(dem_probe_kind) :: kind = 0
    integer(dem_index) :: number(2) = 0, every = 0
  end type

  type, bind(c) :: dem_trajectory_options
    integer(c_size_t) :: struct_size = 88
    real(c_double) :: frame_interval = 0
    logical(c_bool) :: double_precision = .false.
    integer(c_int) :: deflate = 0
    logical(c_bool) :: events = .false.
    integer(c_int32_t) :: fields = 0
    type(c_ptr) :: peaks = c_null_ptr
    integer(dem_index) :: most_stressed = 0, n_probes = 0
    type(c_ptr) :: probes = c_null_ptr
    logical(c_bool) :: breaks = .false., fragments = .false.
    real(c_double) :: history_interval = 0
    logical(c_bool) :: stays_open = .false.
    integer(c_int) :: writers = 0
  end type

  interface

    logical(c_bool) function dem_history_row_due(interval, before, t) bind(c)
      import
      real(c_double), value :: interval, before, t
    end function

    integer(dem_status) function dem_trajectory_create(out, path, simulation, options) bind(c)
      import
      type(c_ptr), intent(out) :: out
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), value :: simulation
      type(dem_trajectory_options), intent(in) :: options
    end function

    integer(dem_status) function dem_trajectory_resume(out, path, simulation, options, checkpoint) bind(c)
      import
      type(c_ptr), intent(out) :: out
      character(kind=c_char), intent(in) :: path(*)
      type(c_ptr), value :: simulation
      type(dem_trajectory_options), intent(in) :: options
      type(c_ptr), value :: checkpoint
    end function

    integer(dem_status) function dem_trajectory_observer(trajectory, out) bind(c)
      import
      type(c_ptr), value :: trajectory
      type(dem_observer), intent(inout) :: out
    end function

    integer(dem_status) function dem_trajectory_note(trajectory, name, text) bind(c)
      import
      type(c_ptr), value :: trajectory
      character(kind=c_char), intent(in) :: name(*), text(*)
    end function

    integer(dem_status) function dem_trajectory_segment(trajectory, checkpoint) bind(c)
      import
      type(c_ptr), value :: trajectory, checkpoint
    end function

    integer(dem_status) function dem_trajectory_finish(trajectory) bind(c)
      import
      type(c_ptr), value :: trajectory
    end function

    subroutine dem_trajectory_destroy(trajectory) bind(c)
      import
      type(c_ptr), value :: trajectory
    end subroutine

    integer(dem_status) function dem_trajectory_read_note(path, name, text, size) bind(c)
      import
      character(kind=c_char), intent(in) :: path(*), name(*)
      character(kind=c_char), intent(out) :: text(*)
      integer(c_size_t), value :: size
    end function

    integer(dem_status) function dem_lattice_read(out, path) bind(c)
      import
      type(dem_lattice), intent(inout) :: out
      character(kind=c_char), intent(in) :: path(*)
    end function

    integer(dem_status) function dem_lattice_measure(path, n_nodes, n_springs) bind(c)
      import
      character(kind=c_char), intent(in) :: path(*)
      integer(dem_index), intent(out) :: n_nodes, n_springs
    end function

    integer(dem_status) function dem_slab_read(out, path, part, n_parts) bind(c)
      import
      type(dem_slab), intent(inout) :: out
      character(kind=c_char), intent(in) :: path(*)
      integer(dem_index), value :: part, n_parts
    end function

    subroutine dem_hdf5_skip_exit() bind(c)
      import
    end subroutine

    type(c_ptr) function c_version_hdf5() bind(c, name='dem_version_hdf5')
      import
    end function

  end interface
end module
