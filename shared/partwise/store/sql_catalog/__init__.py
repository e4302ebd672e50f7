"""`SqlCatalog`: the catalog on SQLite or PostgreSQL. Each method opens one transaction and leaves the rest to `sql`."""

from partwise.store.sql_catalog.accepts import SqlAcceptCatalog
from partwise.store.sql_catalog.base import SqlBase as SqlBase
from partwise.store.sql_catalog.collections import SqlCollectionCatalog
from partwise.store.sql_catalog.drafts import SqlDraftCatalog
from partwise.store.sql_catalog.events import SqlEventCatalog
from partwise.store.sql_catalog.figures import SqlFigureCatalog
from partwise.store.sql_catalog.jobs import SqlJobCatalog
from partwise.store.sql_catalog.labels import SqlLabelCatalog
from partwise.store.sql_catalog.listing import SqlListingCatalog
from partwise.store.sql_catalog.models import SqlModelCatalog
from partwise.store.sql_catalog.queue import SqlQueueCatalog
from partwise.store.sql_catalog.shapes import SqlShapeCatalog
from partwise.store.sql_catalog.stages import SqlStageCatalog
from partwise.store.sql_catalog.tokens import SqlTokenCatalog


class SqlCatalog(
    SqlCollectionCatalog,
    SqlShapeCatalog,
    SqlStageCatalog,
    SqlLabelCatalog,
    SqlModelCatalog,
    SqlQueueCatalog,
    SqlDraftCatalog,
    SqlJobCatalog,
    SqlTokenCatalog,
    SqlEventCatalog,
    SqlListingCatalog,
    SqlAcceptCatalog,
    SqlFigureCatalog,
):
    """A catalog in a database of the known schema; get one from `partwise.store.open`. Safe to share between threads.

    Close it, or use it in a `with` block. See `Catalog` for what methods do.
    """
