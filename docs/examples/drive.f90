! SPDX-License-Identifier: BSD-3-Clause
! The program of drive.c in Fortran: a rubber block in a trap. Its own force pulls every node back to the vertical
! through its place at rest and carries its weight; its own observer stops the run when the block turns back.
!
!     gfortran drive.f90 $(pkg-config --cflags --libs dem-fortran) -o drive && ./drive
module trap
  use dem
  implicit none
  integer, parameter :: frames = 18
  real(c_double), parameter :: gravity = 9.81d0, period = 10d-3, speed = 1, stretch = 1d-4, pi = acos(-1d0)
  real(c_double), parameter :: rate = 2 * pi / period
  type(dem_material), parameter :: rubber = dem_material(youngs_modulus=1d7, poissons_ratio=1 / 3d0, density=1050, &
    thickness=1, guard=0.02d0)

  !> What the callbacks work with. C numbers nodes from 0, and so do these arrays.
  type trapped
    real(c_double), pointer :: mass(:), rest(:, :)
    real(c_double) :: way(2) = 0 !< m, of the centre of mass from its place at rest, at the last frame
    real(c_double) :: stress = 0 !< largest error at the first, as a share
  end type

contains

  !> The force from outside: of each node that is asked about, by its number.
  integer(dem_status) function pull(context, query, force) bind(c)
    type(c_ptr), value :: context
    type(dem_force_query), intent(in) :: query
    real(c_double), intent(inout) :: force(2, *)
    type(trapped), pointer :: b
    integer(dem_index), pointer :: nodes(:)
    real(c_double), pointer :: x(:, :)
    integer(dem_index) :: k
    call c_f_pointer(context, b)
    call c_f_pointer(query%nodes, nodes, [query%n])
    call c_f_pointer(query%x, x, [2_dem_index, query%n])
    do k = 1, query%n
      force(1, k) = -b%mass(nodes(k)) * rate**2 * (x(1, k) - b%rest(1, nodes(k)))
      force(2, k) = b%mass(nodes(k)) * gravity
    end do
    pull = DEM_OK
  end function

  !> The observer: at every frame.
  integer(dem_status) function look(context, simulation) bind(c)
    type(c_ptr), value :: context, simulation
    type(trapped), pointer :: b
    type(dem_state) :: state
    real(c_double), pointer :: x(:, :), v(:, :)
    integer :: k
    call c_f_pointer(context, b)
    look = dem_simulation_state(simulation, state)
    if (look /= DEM_OK) return
    call c_f_pointer(state%x, x, shape(b%rest))
    call c_f_pointer(state%v, v, shape(b%rest))
    do k = 1, 2
      b%way(k) = dot_product(b%mass, x(k, :) - b%rest(k, :)) / sum(b%mass)
    end do
    if (state%t <= 0) b%stress = stress_error(simulation, size(b%mass))
    look = merge(DEM_STOPPED, DEM_OK, dot_product(b%mass, v(1, :)) < 0)
  end function

  real(c_double) function stress_error(simulation, n)
    type(c_ptr), intent(in) :: simulation
    integer, intent(in) :: n
    real(c_double), parameter :: nu = rubber%poissons_ratio
    real(c_double), parameter :: along = rubber%youngs_modulus * stretch / (1 - nu**2)
    real(c_double) :: stress(3, n)
    if (dem_simulation_stress(simulation, stress) /= DEM_OK) error stop
    stress_error = maxval(abs(stress - spread([along, nu * along, 0d0], 2, n))) / along
  end function

  !> Another state than that of the lattice: stretched, and on its way.
  integer(dem_status) function start(simulation, rest)
    type(c_ptr), intent(in) :: simulation
    real(c_double), intent(in) :: rest(:, :)
    real(c_double), dimension(2, size(rest, 2)) :: x, v
    x(1, :) = (1 + stretch) * rest(1, :)
    x(2, :) = rest(2, :)
    v(1, :) = speed
    v(2, :) = 0
    start = dem_simulation_set_motion(simulation, x, v)
  end function

  subroutine check(status)
    integer(dem_status), intent(in) :: status
    if (status == DEM_OK) return
    print '(a)', 'drive: '//dem_status_message()
    error stop
  end subroutine
end module

program drive
  use trap
  implicit none
  type(dem_lattice) :: lattice
  type(dem_lattice), pointer :: held
  type(dem_options) :: options
  type(dem_observer) :: observer
  type(c_ptr) :: model, simulation
  type(trapped), target :: b
  real(c_double), pointer :: mass(:), rest(:, :)
  ! They hold the callbacks against the interfaces that C calls them by.
  procedure(dem_force), pointer :: force => pull
  procedure(dem_observer_frame), pointer :: frame => look
  ! It turns back at a quarter of the period, 4.5 frames.
  real(c_double), parameter :: expected = speed / rate * sin(2 * pi * 5 / frames)

  call check(dem_lattice_rectangle(lattice, 0.04d0, 0.04d0, 0.01d0))
  call check(dem_lattice_assemble(lattice, rubber))
  call check(dem_model_create(model, lattice, n_obstacles=0_dem_index))
  call dem_lattice_free(lattice)
  call c_f_pointer(dem_model_lattice(model), held)
  call c_f_pointer(held%mass, mass, [held%n_nodes])
  call c_f_pointer(held%x, rest, [2_dem_index, held%n_nodes])
  b%mass(0:) => mass
  b%rest(1:, 0:) => rest

  options = dem_options_default()
  options%gravity(2) = -gravity
  options%force = c_funloc(force)
  options%force_context = c_loc(b)
  observer = dem_observer(interval=period / frames, frame=c_funloc(frame), context=c_loc(b))
  call check(dem_simulation_create(simulation, model, options))
  call check(start(simulation, rest))
  call check(dem_simulation_observe(simulation, observer))
  if (dem_simulation_advance(simulation, period) /= DEM_STOPPED) error stop 'it did not turn back'
  call dem_simulation_destroy(simulation)
  call dem_model_destroy(model)

  print '(es15.9, a)', b%way(1), ' m'
  if (norm2(b%way - [expected, 0d0]) > 1d-6 * expected .or. b%stress > 10 * stretch) error stop
end program
