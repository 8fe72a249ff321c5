from .cases import Case as Case, Outcome as Outcome, case_name as case_name
from .folder import read_runs_below as read_runs_below
from .joining import Table as Table, check_parquet as check_parquet, joined as joined
from .running import (
    EnsembleResult as EnsembleResult,
    cases_of as cases_of,
    missing as missing,
    run_ensemble as run_ensemble,
)
from .spec import Ensemble as Ensemble, load_ensemble as load_ensemble
