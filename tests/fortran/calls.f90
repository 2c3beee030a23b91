! SPDX-License-Identifier: BSD-3-Clause
!> One call of each kind: values, arrays, structs in and out, strings, arguments left out, views, callbacks.
module watching
  use dem
  implicit none

  type tally
    integer :: steps = 0
    real(c_double) :: ledger(2) = 0 !< at the start, and now
  end type

contains

  logical(c_bool) function left_half(context, x) bind(c)
    type(c_ptr), value :: context
    real(c_double), intent(in) :: x(2, *)
    left_half = .not. c_associated(context) .and. x(1, 1) < 0
  end function

  integer(dem_status) function look(context, simulation) bind(c)
    type(c_ptr), value :: context, simulation
    type(tally), pointer :: seen
    type(dem_energy) :: energy
    call c_f_pointer(context, seen)
    look = dem_simulation_energy(simulation, energy)
    seen%ledger(2) = energy%ledger
    if (seen%steps == 0) seen%ledger(1) = seen%ledger(2)
    seen%steps = seen%steps + 1
  end function
end module

program calls
  use watching
  implicit none
  real(c_double), target :: floor(2, 2) = reshape([-1d0, 0d0, 1d0, 0d0], [2, 2])
  type(dem_material) :: rubber = dem_material(youngs_modulus=1d7, poissons_ratio=0.4d0, density=1050, thickness=2)
  real(c_double), parameter :: t = 0.1d0
  type(dem_lattice) :: lattice
  type(c_ptr) :: model, simulation
  type(tally), target :: seen, seen_rarely
  integer :: faults = 0

  call strings()
  call lattices()
  call shapes()
  call meshes()
  call models()
  call simulations()
  call checkpoints()
  call readers()
  call dem_simulation_destroy(simulation)
  call dem_model_destroy(model)
  call dem_lattice_free(lattice)
  if (faults > 0) error stop

contains

  subroutine expect(truth, what)
    logical, intent(in) :: truth
    character(*), intent(in) :: what
    if (truth) return
    faults = faults + 1
    print '(a)', 'not so: '//what//' ('//dem_status_message()//')'
  end subroutine

  subroutine succeed(status)
    integer(dem_status), intent(in) :: status
    if (status == DEM_OK) return
    print '(a)', dem_status_message()
    error stop
  end subroutine

  subroutine shapes()
    type(dem_outline), target :: ring = dem_outline(kind=DEM_OUTLINE_RING, radius=2, inner_radius=1)
    type(dem_shape) :: shape
    type(dem_pores) :: recipe = dem_pores(number=3, radius_min=0.1d0, radius_max=0.2d0, wall=0.1d0, seed=1)
    type(dem_shape_report) :: report
    type(dem_lattice) :: made
    real(c_double), target :: pores(3, 3)
    real(c_double) :: area, box(4), pi
    logical(c_bool), allocatable :: inside(:)
    integer(dem_index) :: n
    pi = acos(-1d0)
    shape%outline = c_loc(ring)
    shape%spacing = 0.1d0
    shape%edge = DEM_EDGE_SMOOTH
    call succeed(dem_outline_box(ring, box))
    call expect(maxval(abs(box - [-2, -2, 2, 2])) < 1d-15, 'the box of a ring')
    call succeed(dem_shape_place_pores(shape, recipe, pores, 3_dem_index, n))
    call expect(n == 3 .and. all(pores(3, :) >= 0.1d0), 'pores in columns')
    shape%n_pores = n
    shape%pores = c_loc(pores)
    call succeed(dem_shape_area(shape, area))
    call expect(abs(area/(3*pi - pi*sum(pores(3, :)**2)) - 1) < 1d-3, 'the area of a ring less its pores')
    made = dem_lattice_empty()
    call succeed(dem_shape_lattice(made, shape, report))
    call expect(report%n_rim > 100 .and. report%idle_void == -1, 'its report')
    allocate (inside(made%n_triangles))
    call succeed(dem_lattice_inside(made, ring, 1_dem_index, inside))
    call expect(logical(all(inside)), 'its triangles are inside of the ring')
    ring%inner_radius = 3
    call expect(dem_shape_lattice(made, shape) == DEM_ERROR_ARGUMENT, 'no ring')
    call expect(index(dem_status_message(), 'inner radius') > 0, 'and why')
    call dem_lattice_free(made)
  end subroutine

  subroutine meshes()
    character(*), parameter :: lines(*) = [character(14) :: '$MeshFormat', '4.1 0 8', '$EndMeshFormat', '$Nodes', &
        '1 3 1 3', '2 1 0 3', '7', '8', '9', '0 0 0', '1 0 0', '0 1 0', '$EndNodes', '$Elements', '1 1 1 1', &
        '2 1 2 1', '1 7 9 8', '$EndElements']
    character(:), allocatable, target :: text
    type(dem_mesh) :: mesh = dem_mesh(scale=0.5d0)
    type(dem_lattice) :: made
    real(c_double), pointer :: x(:, :)
    real(c_double) :: apart
    integer :: k
    text = ''
    do k = 1, size(lines)
      text = text//trim(lines(k))//new_line('a')
    end do
    mesh%text = c_loc(text)
    mesh%size = len(text)
    made = dem_lattice_empty()
    call succeed(dem_mesh_lattice(made, mesh))
    call c_f_pointer(made%x, x, [2, 3])
    apart = maxval(abs(x - reshape([0d0, 0d0, 0.5d0, 0d0, 0d0, 0.5d0], [2, 3])))
    call expect(made%n_triangles == 1 .and. apart <= 0d0, 'a mesh')
    call dem_lattice_free(made)
    mesh%size = index(text, '8'//new_line('a')) ! in its second line
    call expect(dem_mesh_lattice(made, mesh) == DEM_ERROR_MODEL, 'no mesh')
    call expect(index(dem_status_message(), 'the mesh:2:') == 1, 'and in which line')
  end subroutine

  subroutine strings()
    type(dem_method_traits) :: traits
    integer(dem_method) :: method
    integer(dem_kernel) :: kernel
    call expect(dem_kernel_find(kernel, 'none'//c_null_char) == DEM_ERROR_ARGUMENT, 'no such kernel')
    call expect(index(dem_status_message(), '''none''') > 0, 'the message names it')
    call expect(dem_kernel_name(DEM_KERNEL_AVX2) == 'avx2', 'a kernel''s name')
    call expect(dem_status_name(DEM_ERROR_IO) == 'DEM_ERROR_IO', 'name of a status')
    call expect(dem_status_name(99) == '', 'no name of an unknown status')
    call expect(dem_kernel_name(99) == '', 'no name')
    call succeed(dem_method_find(method, 'verlet'//c_null_char))
    call succeed(dem_method_describe(traits, method))
    call expect(method == DEM_METHOD_VERLET, 'a method by its name')
    call expect(dem_string(traits%name) == 'verlet', 'the name of a method')
    call expect(index(dem_version(), '.') > 0, 'our version')
    call expect(index(dem_version_hdf5(), '.') > 0, 'version of HDF5')
    call expect(index(dem_version_sundials(), '.') > 0, 'version of SUNDIALS')
  end subroutine

  !> Thirteen rows, of eleven and ten nodes in turn; of each row five are on the left.
  subroutine lattices()
    integer(dem_index) :: n_parts
    integer(dem_index), allocatable :: part(:)
    call succeed(dem_lattice_rectangle(lattice, 1d0, 1d0, 0.1d0))
    call succeed(dem_lattice_cut(lattice, left_half, c_null_ptr))
    call expect(lattice%n_nodes == 65, 'its left half')
    call succeed(dem_lattice_assemble(lattice, rubber))
    allocate (part(lattice%n_nodes))
    call succeed(dem_lattice_parts(lattice, n_parts, part))
    call expect(n_parts == 1 .and. all(part == 0), 'one part')
    n_parts = 0
    call succeed(dem_lattice_parts(lattice, n_parts))
    call expect(n_parts == 1, 'only the number of parts')
    call dem_lattice_move(lattice, 0d0, [0d0, 1d0])
  end subroutine

  subroutine models()
    type(dem_obstacle) :: granite
    type(dem_constants) :: constants
    type(dem_csr) :: csr
    type(dem_lattice), pointer :: held
    integer(dem_index), pointer :: row(:)
    real(c_double) :: value(2), direction(2)
    granite = dem_obstacle(n_points=2, points=c_loc(floor), restitution=0.5d0)
    call succeed(dem_model_create(model, lattice, [granite], 1_dem_index))
    call expect(abs(dem_model_gap(model, [0.3d0, 0.25d0]) - 0.25d0) < 1d-15, 'the gap to the floor')
    call succeed(dem_model_constants(model, 0_dem_index, constants))
    call expect(abs(constants%youngs_modulus / rubber%youngs_modulus - 1) < 1d-9, 'E of a regular lattice')
    call expect(abs(constants%stiffness(2, 1) / constants%stiffness(1, 1) - rubber%poissons_ratio) < 1d-9, 'nu')
    call succeed(dem_model_csr(model, csr))
    call c_f_pointer(csr%row, row, [csr%n_nodes + 1])
    call c_f_pointer(dem_model_lattice(model), held)
    call expect(row(csr%n_nodes + 1) == 2 * held%n_springs .and. held%n_nodes == csr%n_nodes, 'two slots a spring')
    call expect(abs(dem_stress_von_mises([3d0, 3d0, 0d0]) - 3) < 1d-15, 'von Mises of equal tensions')
    call dem_stress_principal([0d0, 0d0, 2d0], value, direction)
    call expect(all(abs(value - [2, -2]) < 1d-15) .and. abs(direction(1) - direction(2)) < 1d-15, 'pure shear')
  end subroutine

  !> It falls freely: v = -g t, no stress, and what the observer saw of the energy is constant.
  subroutine simulations()
    type(dem_options) :: options
    type(dem_observer) :: observer
    type(dem_body_motion) :: motion
    type(dem_state) :: state
    real(c_double), pointer :: v(:, :)
    real(c_double), allocatable :: stress(:, :)
    procedure(dem_observer_step), pointer :: step
    options = dem_options_default()
    step => look
    observer%step = c_funloc(step)
    observer%context = c_loc(seen)
    call succeed(dem_simulation_create(simulation, model, options))
    call succeed(dem_simulation_observe(simulation, observer))
    observer%step_every = 5
    observer%context = c_loc(seen_rarely)
    call succeed(dem_simulation_observe(simulation, observer))
    call succeed(dem_simulation_advance(simulation, t))
    call succeed(dem_simulation_state(simulation, state))
    call succeed(dem_simulation_body(simulation, 0_dem_index, motion))
    call c_f_pointer(state%v, v, [2_dem_index, lattice%n_nodes])
    allocate (stress(3, lattice%n_nodes))
    call succeed(dem_simulation_stress(simulation, stress))
    call expect(maxval(abs(v(2, :) + 9.81d0 * state%t)) < 1d-9 .and. maxval(abs(v(1, :))) < 1d-9, 'it falls')
    call expect(abs(motion%velocity(2) + 9.81d0 * t) < 1d-9, 'its mean motion')
    call expect(maxval(abs(stress)) < 1d-9 * rubber%youngs_modulus, 'no stress')
    call expect(seen%steps > 1 .and. abs(seen%ledger(2) - seen%ledger(1)) < 1d-6 * abs(seen%ledger(1)), 'the ledger')
    call expect(seen_rarely%steps == (seen%steps - 1)/5 + 1, 'every fifth step')
  end subroutine

  subroutine checkpoints()
    type(c_ptr) :: checkpoint, entry
    real(c_double), target :: written(3) = [1d0, 2d0, 3d0], read(3) = 0
    integer(c_size_t) :: bytes
    call succeed(dem_checkpoint_create(checkpoint))
    call succeed(dem_checkpoint_put(checkpoint, 'mine'//c_null_char, c_loc(written), c_sizeof(written)))
    call succeed(dem_checkpoint_get(checkpoint, 'mine'//c_null_char, c_loc(read), c_sizeof(read)))
    call expect(maxval(abs(read - written)) < 1d-300, 'the same')
    entry = dem_checkpoint_find(checkpoint, 'mine'//c_null_char, bytes)
    call expect(c_associated(entry) .and. bytes == 24, 'found')
    call dem_checkpoint_destroy(checkpoint)
  end subroutine

  !> A run written to the file that is named on the command line, and read back.
  subroutine readers()
    type(dem_observer) :: observer
    type(dem_trajectory_options) :: options
    type(dem_reader_array), pointer :: array
    type(c_ptr) :: falling, file, reader
    character(:), allocatable :: path
    character(kind=c_char) :: note(8)
    real(c_double), pointer :: times(:)
    real(c_double), allocatable :: x(:, :), v(:, :)
    integer(dem_index) :: n_frames
    integer :: length
    call get_command_argument(1, length=length)
    allocate (character(length) :: path)
    call get_command_argument(1, path)
    path = path//c_null_char
    options = dem_trajectory_options_default()
    options%frame_interval = t / 2
    call succeed(dem_simulation_create(falling, model, dem_options_default()))
    call succeed(dem_trajectory_create(file, path, falling, options))
    call succeed(dem_trajectory_note(file, 'mine'//c_null_char, 'a note'//c_null_char))
    call succeed(dem_trajectory_observer(file, observer))
    call succeed(dem_simulation_observe(falling, observer))
    call succeed(dem_simulation_advance(falling, t))
    call succeed(dem_trajectory_finish(file))
    call dem_trajectory_destroy(file)
    call dem_simulation_destroy(falling)

    call succeed(dem_trajectory_read_note(path, 'mine'//c_null_char, note, size(note, kind=c_size_t)))
    call expect(transfer(note(:6), 'a note') == 'a note' .and. note(7) == c_null_char, 'the note')
    call succeed(dem_reader_open(reader, path))
    call c_f_pointer(dem_reader_times(reader, n_frames), times, [3])
    call expect(n_frames == 3 .and. maxval(abs(times - [0d0, t / 2, t])) < 1d-15, 'three frames')
    call c_f_pointer(dem_reader_array_find(reader, 'velocity'//c_null_char), array)
    call expect(dem_string(array%unit) == 'm/s' .and. array%components == 3, 'velocities in three components')
    allocate (x(2, lattice%n_nodes), v(array%components, lattice%n_nodes))
    call succeed(dem_reader_positions(reader, n_frames - 1, x))
    call succeed(dem_reader_read(reader, array, n_frames - 1, v))
    call expect(abs(minval(x(2, :)) - 1 + 9.81d0 * t**2 / 2) < 1d-9, 'how far it fell')
    call expect(maxval(abs(v(2, :) + 9.81d0 * t)) < 1d-6, 'how fast, in single precision')
    call dem_reader_close(reader)
  end subroutine
end program
