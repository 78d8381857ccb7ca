# Seconds of long tests. ctest starts the longest first, so that no processor waits for the last one. It keeps durations
# of its own in a build folder that has run the tests before. Tests that a build does not have are ignored.
set_tests_properties(DocumentedCommands.RunAsWritten ShadowClasses.AreRightAtNinetyNineOfAHundredRandomPoints
    SolveScene.LosesNoLightInClosedScenes DiffusingPanes.LightInADarkRoomAgreesWithPathTracing PROPERTIES COST 100)
set_tests_properties(ProgramProcessor.RunsWithoutAvxOrSaysThatItNeedsIt LightGroupsOfTwoLamps.DimmedLightAgreesWithANewSolve
    LightGroupsOfTwoLamps.RepaintedLightAgreesWithANewSolve DiffusingPanes.TwoUniformRoomsStayUniform
    Daylight.ASmallerRequestedErrorIsReached DistantMeans.AreThoseOfExactLightOfASky PROPERTIES COST 50)
set_tests_properties(RayLightOnElements.MeanLightIsThatOfAllElements CurvedLight.DirectAndIndirectMapsAddUpToThatOfAllLight
    Checkpoint.EverySavedStateOfARefiningAttemptLeadsToTheSameBits PublishedForm.FormsOnConstantElementsAreForecast
    Hierarchy.ErrorOfLinksFallsWithTheirTolerance DiffusingPanes.GrowingCellsPassLight PROPERTIES COST 30)
set_tests_properties(VerbsOfProcesses.FailTogetherWithOneMessage
    ProgramClassical.AnInterruptedSolveKeepsACheckpointThatIsContinued Shooting.IsTheSameOnAnyNumberOfThreads
    ProgramSolve.ASignalEndsTheWorkAndAvailableLightIsWritten PROPERTIES COST 15)
