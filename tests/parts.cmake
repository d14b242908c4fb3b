# Which tests run where. A test runs in every landing (`./check`) unless it stands in a list `long_FOLDER`, or in a
# suite whose name ends in `Long`: those are `./check long`, of which continuous integration does a fifth at each
# landing. Tests of `rotating_FOLDER` run everywhere with a fifth of their cases, and in `./check long` with all.
# The table in docs/contributing.md says what still proves the same in every landing.
#
# The lists are gtest filters, one pattern a word. A landing in five runs each long test: which one, follows from the
# hash of its name, or for whole programs from `fifths_FOLDER`.
set(sanitize FALSE)
if(CMAKE_BUILD_TYPE STREQUAL Sanitize)
  set(sanitize TRUE)
endif()

if(NOT sanitize)
  # Whole cases of validation with a parameter that is wrong, or has no say, but for the shortest of each kind.
  set(long_validate
    Cases/ValidationCase.HoldsAndExplainsItself/rope_torsion_free
    Cases/ValidationCase.HoldsAndExplainsItself/rope_torsion_held
    Cases/ValidationCase.HoldsAndExplainsItself/loop_loss
    Cases/WrongParameter.* Cases/UnrelatedParameter.*
    -*Parameter.*/ring_energy_* *Parameter.*/stretch_and_cantilever_* *Parameter.*/crossing_torque_*)
  # What the atoms of a tube that slides lose: their strength is measured in LAMMPS in every landing.
  set(long_calibrate SlidingInLammps.DragIsFarBelowTheStrength)
  # Processes of a campaign or a calibration that are broken off at many places; the calibration of a second tube.
  set(long_cli FaultsOfProcesses.* Calibrate.AThinTubesSet* -FaultsOfProcesses.ThresholdBrokenOff)
  set(rotating_cli Faults.RunKilledAtAnyCall Faults.RunKilledInAnyWrite Faults.RunToldToStopAtAnyCall
    Faults.ResumeKilledAtAnyCall Faults.RelaxationEndedAtAnyCall Faults.DiskFullFromAnyCallOfARun
    Faults.DiskFullFromAnyCallOfAResume Faults.AnyCallOfARunFailsOnce Faults.SignalsInAnyCallAreOfNoConsequence
    Faults.SweepKilledAndGoneOnWith Faults.OtherVerbsKilledOrOutOfDisk Faults.RefinedRunKilledAndGoneOnWith
    Surroundings.AHostileRunDirectoryReachesNothingOutside Surroundings.AHostileCampaignReachesNothingOutside)
  # The film of LammpsEvents has all that terms remember on ranks in every landing.
  set(long_lammps LammpsEvents.TubesBreak* LammpsEvents.LinksOf* LammpsEvents.LinksForm* LammpsRun.FrictionSlides*
    LammpsRun.ARankSends* LammpsRun.TethersHold*)
  set(long_scripts python.wheel install.Package docs.Tutorial/phase-diagram docs.Tutorial/tube docs.Gallery
    readers.Snakemake)
else()
  # The sanitizers look at memory and integers, not at numbers. Every landing reads files and damaged input, and runs
  # the engines and force terms; the programs as a whole, their dynamics and LAMMPS take turns. Left out are statistics,
  # statics and dynamics against theory, calibration and validation: scenes for an engine that the tests below hold.
  # validate/ is not built, and the tests' own code is compiled with -O0.
  set(only_unit "*" -Laws/ContactLawTest.EnergyAndForceAreContinuous*)  # 8 million evaluations of laws in headers
  # Tests from a "-" on are left out: they take a minute each, and hold numbers or what others show on smaller scenes.
  set(only_physics Checkpoint.* SameBits.* FollowingStep.* ListSkin.* Refined.* Gauges.GoOn* Grip.LetsGo*
    Relaxation.Interrupted* Steps.* Device.* Langevin.GivesTheSameBits* Schedule.* Segments.* PeriodicSlice.ForcesAre*
    Tether* -Steps.OfALargeScene* Device.OpenCl* Device.ErrorsAndWork* ListSkin.FollowsTheMotion*)
  set(only_cli Cli.* Foreign.* HostileScenes.* RunDirectoryOf.* View.ADamaged* View.AReport* Campaign.TableIs*
    Campaign.FailedPoints* Campaign.BranchesGoOn* Limits.ARefinedRun* Limits.AStoppedRun* Faults.DamagedCheckpoints
    Faults.LostTails Faults.ClosedStandardStreams Faults.NobodyCanRead* Calibrate.WrongInput*
    -Cli.PlanRunAndCheck* Cli.ErrorsOfTheSet*)
  set(only_lammps LammpsErrors.* LammpsRun.ThereAndBack* LammpsRun.GoesOnFromTheLast* LammpsRun.Import*
    LammpsRun.RanksWithout* *FiveStatesTest.ForcesEnergies* *ProtocolTest.*)
  # Scenes of some seconds, which take a minute here; shorter ones of the same terms stay.
  set(long_unit Campaigns.* Stops.* SlidingRope.* EndDrives.* EndContact.IsTheSum* Links.OfTwoTables* Failure.SameBits*
    Failure.TheAccount* Failure.LimitsAre* Failure.StoredEvents* Film.RestingTubesHave* Film.NothingIsCloser*
    Line/ForcesTest.FastEqualsReferenceFarFromTheOrigin/*ManyNodes)
  set(long_physics "*")
  set(fifths_physics 1)
  set(long_lammps "*")
  set(fifths_lammps 2)
  set(long_cli "*")
  set(fifths_cli 3 4 5)
endif()
