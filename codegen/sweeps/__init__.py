"""Many runs of one model: designs, workers, measures, stores."""
